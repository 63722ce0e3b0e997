// Forces that functions of the program compute: controllers, contact, measured loads.

#ifndef PC_FORCE_HPP
#define PC_FORCE_HPP

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "../pc.h"
#include "call.hpp"
#include "catching.hpp"
#include "view.hpp"

namespace pc {

/// Writes the external forces at (t, y) to q, as many as were declared, in that order. A force left
/// unwritten is NaN, which means that it is not defined there: a smaller step is tried.
using force_function = std::function<void(double t, view<const double> y, view<double> q)>;
/// Writes their derivatives, ∂q_i/∂y_j to dq[i + j*e] for e forces.
using force_jacobian = std::function<void(double t, view<const double> y, view<double> dq)>;

namespace detail {

/// The functions of a system and its copies.
struct forces {
    force_function function;
    force_jacobian jacobian;
};

/// The first exception of several threads.
class first_thrown {
public:
    void keep() noexcept
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        if (!thrown_) {
            thrown_ = std::current_exception();
        }
    }
    void rethrow()
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        if (thrown_) {
            std::rethrow_exception(std::exchange(thrown_, nullptr));
        }
    }

private:
    std::mutex mutex_{};
    std::exception_ptr thrown_{};
};

/// The argument given to C: the functions, and what keeps their exceptions unless the catching of
/// their thread does.
struct force_user {
    std::shared_ptr<const forces> functions;
    first_thrown *elsewhere;

    static int force(double t, const double *y, std::size_t dim, double *q, std::size_t count, void *user) noexcept
    {
        const auto &self = *static_cast<const force_user *>(user);
        return self.answer(self.functions->function, t, {y, dim}, {q, count});
    }
    static int jacobian(double t, const double *y, std::size_t dim, double *dq, std::size_t count, void *user) noexcept
    {
        const auto &self = *static_cast<const force_user *>(user);
        return self.answer(self.functions->jacobian, t, {y, dim}, {dq, count});
    }
    static void destroy(void *user) noexcept { delete static_cast<force_user *>(user); }

private:
    template <class Function>
    int answer(const Function &function, double t, view<const double> y, view<double> values) const noexcept
    {
        constexpr int give_up = -1;
        const auto compute = [&] {
            function(t, y, values);
            return 0;
        };
        if (!elsewhere) {
            return catching::guard(give_up, compute);
        }
        try {
            return compute();
        } catch (...) {
            elsewhere->keep();
            return give_up;
        }
    }
};

/// Sets the functions of a system; C reports an empty function.
inline void set_force(pc_system *system, std::shared_ptr<const forces> functions, first_thrown *elsewhere = nullptr)
{
    const auto force = functions->function ? &force_user::force : nullptr;
    const auto jacobian = functions->jacobian ? &force_user::jacobian : nullptr;
    auto user = std::make_unique<force_user>(force_user{std::move(functions), elsewhere});
    call(pc_system_set_force, system, force, jacobian, user.release(), &force_user::destroy);
}

} // namespace detail
} // namespace pc

#endif // PC_FORCE_HPP
