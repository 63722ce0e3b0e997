// Many motions at once.

#ifndef PC_ENSEMBLE_HPP
#define PC_ENSEMBLE_HPP

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

#include "../pc.h"
#include "call.hpp"
#include "catching.hpp"
#include "force.hpp"
#include "options.hpp"
#include "system.hpp"
#include "view.hpp"

namespace pc {

/// The result of a member of an ensemble, valid while its observer is called.
struct member {
    std::size_t number;
    /// PC_OK, PC_EVENT, or the status of a failure, which the message explains.
    pc_status status;
    std::string_view message;
    /// The output times that it reached, and the states at these times, one after the other.
    view<const double> times, states;

    /// The state at times[row].
    view<const double> state(std::size_t row) const noexcept
    {
        const std::size_t dim = states.size() / times.size();
        return {states.data() + row * dim, dim};
    }
};

/// Receives a member; returning false stops the ensemble.
using member_observer = std::function<bool(const member &of)>;

namespace detail {

inline int tell_member(const pc_member *of, void *user) noexcept
{
    constexpr int stop = 1;
    return catching::guard(stop, [&] {
        const member told{of->number, of->status, of->message ? of->message : "", {of->times, of->rows},
                          {of->states, of->rows * of->dim}};
        return (*static_cast<member_observer *>(user))(told) ? 0 : stop;
    });
}

/// A system whose forces throw on threads without a call of these headers.
struct told_elsewhere {
    static std::optional<system> copy(const system &of, first_thrown &thrown)
    {
        if (!of.forces_) {
            return std::nullopt;
        }
        system copy = of.clone();
        set_force(copy.get(), of.forces_, &thrown);
        return copy;
    }
};

} // namespace detail

/// Integrates many members through the times: from `states` at t, member by member, or from the
/// start of the model if there are none, and with `parameters`, member by member, or those of the
/// system if there are none. Calls `observe` for each in order until it returns false; returns
/// whether it never did. `threads` is 0 for one on each core.
///
/// What `observe` throws stops the ensemble and comes out. A member whose forces throw is reported
/// as failed, the others continue, and the first exception comes out at the end.
inline bool run_ensemble(const system &of, double t, view<const double> states, view<const double> parameters,
                         view<const double> times, const member_observer &observe, std::size_t threads = 0,
                         const solver_options &options = {})
{
    const auto count = [](view<const double> rows, std::size_t width) { return width == 0 ? 0 : rows.size() / width; };
    const auto given = [](view<const double> rows) { return rows.empty() ? nullptr : rows.data(); };
    const std::size_t members = states.empty() ? count(parameters, of.parameter_count()) : count(states, of.dim());
    const auto told = observe ? &detail::tell_member : nullptr;
    void *user = const_cast<member_observer *>(&observe);
    detail::first_thrown thrown;
    const std::optional<system> copy = detail::told_elsewhere::copy(of, thrown);
    const pc_system *integrated = copy ? copy->get() : of.get();
    const pc_solver_options chosen = options.get();
    const pc_status status =
        detail::call(pc_ensemble_run, integrated, &chosen, members, t, given(states), states.size(),
                     given(parameters), parameters.size(), times.data(), times.size(), threads, told, user);
    thrown.rethrow();
    return status == PC_OK;
}

} // namespace pc

#endif // PC_ENSEMBLE_HPP
