// Integration.

#ifndef PC_SOLVER_HPP
#define PC_SOLVER_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../pc.h"
#include "call.hpp"
#include "checkpoint.hpp"
#include "dense.hpp"
#include "event.hpp"
#include "options.hpp"
#include "system.hpp"
#include "view.hpp"

namespace pc {

/// The value of a function of a motion, and its derivatives by the start and by the parameters.
struct gradient {
    double value;
    vector by_start, by_parameters;
};

/// The largest Lyapunov exponents of the motion from (t, y), so many of them, over a number of intervals of time after the
/// first few, `transient`.
inline vector lyapunov_exponents(const system &of, double t, view<const double> y, std::size_t count, double interval,
                                 std::uint32_t intervals, std::uint32_t transient = 0,
                                 const solver_options &options = {})
{
    const pc_solver_options chosen = options.get();
    vector exponents(count);
    detail::call(pc_system_lyapunov, of.get(), &chosen, t, y.data(), y.size(), interval, intervals, transient,
                 exponents.data(), exponents.size());
    return exponents;
}

/// The gradient of h(t_end) + ∫ g dt along the motion from (t, y) for observables h and g, by their indices, if they are given.
/// The derivatives by parameters need model::differentiate().
inline gradient gradient_of(const system &of, double t, view<const double> y, double t_end,
                            std::optional<std::size_t> end, std::optional<std::size_t> density = std::nullopt,
                            bool by_parameters = true, const solver_options &options = {})
{
    const pc_solver_options chosen = options.get();
    gradient found{0.0, vector(of.dim()), vector(by_parameters ? of.parameter_count() : 0)};
    detail::call(pc_system_gradient, of.get(), &chosen, t, y.data(), y.size(), t_end, end.value_or(SIZE_MAX),
                 density.value_or(SIZE_MAX), &found.value, found.by_start.data(), found.by_start.size(),
                 by_parameters ? found.by_parameters.data() : nullptr, found.by_parameters.size());
    return found;
}

/// An integration, with its current time and state.
///
/// What a function, an observer or a force of the system throws ends the call that called it, and
/// comes out there. The integration then stays at what it reached, given by time() and state().
class solver {
public:
    /// From the start of the model.
    explicit solver(const system &of, const solver_options &options = {}) : dim_(of.dim())
    {
        const pc_solver_options chosen = options.get();
        detail::call(pc_solver_new, of.get(), &chosen, 0.0, nullptr, std::size_t(0), handle_.place());
    }
    /// From the state y at the time t.
    solver(const system &of, double t, view<const double> y, const solver_options &options = {}) : dim_(of.dim())
    {
        const pc_solver_options chosen = options.get();
        const double nothing = 0.0; // a null pointer would mean the start of the model
        detail::call(pc_solver_new, of.get(), &chosen, t, y.empty() ? &nothing : y.data(), y.size(), handle_.place());
    }
    /// From a checkpoint.
    static solver restore(const system &of, view<const unsigned char> checkpoint, const solver_options &options = {})
    {
        const pc_solver_options chosen = options.get();
        return solver(detail::make<handle>(pc_solver_restore, of.get(), &chosen, checkpoint.data(), checkpoint.size()),
                      of.dim());
    }

    /// Follows an event of your program; to be called before the first step.
    void add_event(const std::string &name, pc_direction direction, bool terminal, event_function function,
                   event_reset reset = nullptr)
    {
        using user = detail::event_user;
        const auto value = function ? &user::value : nullptr;
        const auto change = reset ? &user::change : nullptr;
        auto event = std::make_unique<user>(user{std::move(function), std::move(reset)});
        detail::call(pc_solver_add_event, get(), name.c_str(), direction, terminal, value, change, event.release(),
                     &user::destroy);
    }
    /// Calls `observe` for each event from now on; for none if it is empty.
    void observe_events(event_observer observe)
    {
        const auto told = observe ? &detail::tell_event : nullptr;
        auto kept = std::make_unique<event_observer>(std::move(observe));
        detail::call(pc_solver_observe_events, get(), told, kept.get());
        event_observer_ = std::move(kept);
    }

    /// Calls `follow` after each step of the method from now on; nothing if it is empty.
    void set_monitor(monitor follow)
    {
        using user = detail::monitor_user;
        const auto told = follow ? &user::tell : nullptr;
        auto kept = std::make_unique<user>(user{std::move(follow)});
        detail::call(pc_solver_set_monitor, get(), told, kept.release(), &user::destroy);
    }
    /// Begins anew from the state y at the time t, as a new solver would, with the events, observers and sensitivities of
    /// this one.
    void reset(double t, view<const double> y) { detail::call(pc_solver_reset, get(), t, y.data(), y.size()); }

    /// Continues with the current parameters and inputs of the system.
    void take_parameters(const system &from) { detail::call(pc_solver_take_parameters, get(), from.get()); }

    /// Also integrates the derivative of the state with respect to a parameter; `start` is that of the
    /// start, 0 if empty.
    void add_sensitivity(std::size_t parameter, const vector &start = {})
    {
        detail::call(pc_solver_add_sensitivity, get(), parameter, start.empty() ? nullptr : start.data(), start.size());
    }
    /// An added derivative at the current time.
    vector sensitivity(std::size_t number) const
    {
        vector column(dim_);
        detail::call(pc_solver_sensitivity, get(), number, column.data(), column.size());
        return column;
    }

    /// The state at t, or where an event or its observer ended the call: see ended_by() and time().
    vector advance(double t)
    {
        vector y(dim_);
        advance(t, y);
        return y;
    }
    /// Writes this state, and returns how the call ended: PC_OK, PC_EVENT or PC_STOPPED.
    pc_status advance(double t, view<double> y)
    {
        return detail::call(pc_solver_advance, get(), t, y.data(), y.size());
    }
    /// The state at the end, time(), of one step of the method in the direction of `towards`.
    vector step(double towards)
    {
        vector y(dim_);
        step(towards, y);
        return y;
    }
    pc_status step(double towards, view<double> y)
    {
        double t = 0.0;
        return detail::call(pc_solver_step, get(), towards, &t, y.data(), y.size());
    }
    /// Calls `observe` at each time until it returns false; returns whether all times were reached.
    bool run(view<const double> times, const observer &observe)
    {
        const auto told = observe ? &detail::tell_state : nullptr;
        void *user = const_cast<observer *>(&observe);
        return detail::call(pc_solver_run, get(), times.data(), times.size(), told, user) == PC_OK;
    }
    /// The motion up to t, or to where an event or its observer ended it.
    dense run_dense(double t) { return dense(detail::make<dense::handle>(pc_solver_run_dense, get(), t)); }

    double time() const
    {
        double t = 0.0;
        detail::call(pc_solver_time, get(), &t);
        return t;
    }
    vector state() const
    {
        vector y(dim_);
        state(y);
        return y;
    }
    void state(view<double> y) const { detail::call(pc_solver_state, get(), y.data(), y.size()); }
    /// A derivative of y, or y itself, inside the last step.
    vector interpolate(double t, unsigned derivative = 0)
    {
        vector y(dim_);
        interpolate(t, derivative, y);
        return y;
    }
    void interpolate(double t, unsigned derivative, view<double> y)
    {
        detail::call(pc_solver_interpolate, get(), t, derivative, y.data(), y.size());
    }
    pc_statistics statistics() const
    {
        pc_statistics work{};
        detail::call(pc_solver_statistics, get(), &work, sizeof work);
        return work;
    }
    /// The weights 1/(rtol |y| + atol) of the components in the error test of the last step.
    vector error_weights() const
    {
        vector weights(dim_);
        detail::call(pc_solver_errors, get(), weights.data(), weights.size(), nullptr, std::size_t(0));
        return weights;
    }
    /// The estimated errors of the components in the last step, where the method has them.
    vector local_errors() const
    {
        vector errors(dim_);
        detail::call(pc_solver_errors, get(), nullptr, std::size_t(0), errors.data(), errors.size());
        return errors;
    }
    /// Time and state, for restore().
    bytes checkpoint(const std::string &label = "")
    {
        detail::owned<void, pc_bytes_free> data;
        std::size_t length = 0;
        detail::call(pc_solver_checkpoint, get(), label.c_str(), data.place(), &length);
        const auto *first = static_cast<const unsigned char *>(data.get());
        return bytes(first, first + length);
    }

    std::size_t event_count() const noexcept { return pc_solver_event_count(get()); }
    std::vector<std::string> event_names() const { return detail::names(get(), pc_solver_event_name, event_count()); }
    /// How often an event has occurred.
    std::uint64_t occurrences(std::size_t event) const
    {
        std::uint64_t count = 0;
        detail::call(pc_solver_event_occurrences, get(), event, &count);
        return count;
    }
    /// Its last occurrence, if there was one.
    std::optional<occurrence> last_occurrence(std::size_t event) const
    {
        if (occurrences(event) == 0) {
            return std::nullopt;
        }
        occurrence last{event, 0.0, vector(dim_), vector(dim_)};
        detail::call(pc_solver_last_occurrence, get(), event, &last.t, last.before.data(), dim_, last.after.data(),
                     dim_);
        return last;
    }
    /// The terminal event that ended the last call, if one did.
    std::optional<std::size_t> ended_by() const
    {
        std::size_t event = 0;
        const pc_status status = pc_solver_terminal_event(get(), &event, nullptr);
        return status == PC_OK ? std::optional<std::size_t>(event) : std::nullopt;
    }
    pc_solver *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_solver, pc_solver_free>;

    solver(handle made, std::size_t dim) : handle_(std::move(made)), dim_(dim) {}

    // It keeps its address when the solver moves, and outlives the handle.
    std::unique_ptr<event_observer> event_observer_{};
    handle handle_{};
    std::size_t dim_;
};

} // namespace pc

#endif // PC_SOLVER_HPP
