// Events and observers of an integration.

#ifndef PC_EVENT_HPP
#define PC_EVENT_HPP

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "../pc.h"
#include "catching.hpp"
#include "view.hpp"

namespace pc {

/// An event that occurred, by its number, with the states before and after it.
struct occurrence {
    std::size_t event;
    double t;
    vector before, after;
};

/// g(t, y), which passes through zero where the event occurs. It is NaN where it has no value,
/// which is not a failure after an event that is found before.
using event_function = std::function<double(double t, view<const double> y)>;
/// Turns the state before an event into the one after it.
using event_reset = std::function<void(double t, view<double> y)>;
/// Receives an event; returning false stops the call.
using event_observer = std::function<bool(const occurrence &event)>;
/// Receives a state; returning false stops the call.
using observer = std::function<bool(double t, view<const double> y)>;

/// The end of a step of the method, or of the part of it before an event.
struct step_end {
    double t;
    view<const double> y;
    /// The order of the method, and the length of the step with the sign of its direction.
    int order;
    double length;
};

/// Receives the end of each step; returning false stops the call.
using monitor = std::function<bool(const step_end &step)>;

namespace detail {

/// What these functions return to C if they throw.
constexpr int stop = 1;

/// An event of the program, for C.
struct event_user {
    event_function function;
    event_reset reset;

    static int value(double t, const double *y, std::size_t dim, double *value, void *user) noexcept
    {
        return catching::guard(stop, [&] {
            *value = static_cast<event_user *>(user)->function(t, {y, dim});
            return 0;
        });
    }
    static int change(double t, double *y, std::size_t dim, void *user) noexcept
    {
        return catching::guard(stop, [&] {
            static_cast<event_user *>(user)->reset(t, {y, dim});
            return 0;
        });
    }
    static void destroy(void *user) noexcept { delete static_cast<event_user *>(user); }
};

inline int tell_event(std::size_t event, double t, const double *before, const double *after, std::size_t dim,
                      void *user) noexcept
{
    return catching::guard(stop, [&] {
        const occurrence now{event, t, vector(before, before + dim), vector(after, after + dim)};
        return (*static_cast<event_observer *>(user))(now) ? 0 : stop;
    });
}

inline int tell_state(double t, const double *y, std::size_t dim, void *user) noexcept
{
    return catching::guard(stop, [&] { return (*static_cast<observer *>(user))(t, {y, dim}) ? 0 : stop; });
}

/// A monitor, for C.
struct monitor_user {
    monitor function;

    static int tell(double t, const double *y, std::size_t dim, int order, double length, void *user) noexcept
    {
        return catching::guard(stop, [&] {
            return static_cast<monitor_user *>(user)->function({t, {y, dim}, order, length}) ? 0 : stop;
        });
    }
    static void destroy(void *user) noexcept { delete static_cast<monitor_user *>(user); }
};

} // namespace detail
} // namespace pc

#endif // PC_EVENT_HPP
