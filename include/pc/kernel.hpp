// The right-hand side for an integrator of your own.

#ifndef PC_KERNEL_HPP
#define PC_KERNEL_HPP

#include <cstddef>
#include <stdexcept>
#include <string>

#include "../pc.h"
#include "call.hpp"
#include "catching.hpp"
#include "system.hpp"
#include "view.hpp"

namespace pc {

/// f(t, y) for one thread, with the parameters and the forces that the system had. get() is the
/// context of pc_kernel_rhs and pc_kernel_jacobian, for an integrator that takes functions of C; a
/// catching then keeps what forces throw.
class kernel {
public:
    explicit kernel(const system &of)
        : handle_(detail::make<handle>(pc_kernel_new, of.get())), dim_(pc_kernel_dim(get()))
    {
    }

    std::size_t dim() const noexcept { return dim_; }
    void set_parameters(view<const double> values)
    {
        detail::call(pc_kernel_set_parameters, get(), values.data(), values.size());
    }
    /// Writes f(t, y). Returns 0; 1 where it cannot be evaluated and a smaller step may help; -1
    /// where no step helps.
    int operator()(double t, view<const double> y, view<double> ydot)
    {
        return at(pc_kernel_rhs, dim_, t, y, ydot);
    }
    /// Writes ∂f/∂y, column-major; otherwise as f.
    int jacobian(double t, view<const double> y, view<double> matrix)
    {
        return at(pc_kernel_jacobian, dim_ * dim_, t, y, matrix);
    }
    /// Writes f of states that follow one another; otherwise as f.
    int many(double t, view<const double> states, view<double> rates)
    {
        if (states.size() % dim_ != 0 || rates.size() != states.size()) {
            throw std::invalid_argument("a kernel of dimension " + std::to_string(dim_) + " was given " +
                                        std::to_string(states.size()) + " numbers of states, and room for " +
                                        std::to_string(rates.size()));
        }
        catching thrown;
        const int code = pc_kernel_rhs_many(t, states.data(), states.size() / dim_, rates.data(), get());
        thrown.rethrow();
        return code;
    }
    pc_kernel *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_kernel, pc_kernel_free>;
    using function = int (*)(double, const double *, double *, void *);

    int at(function of, std::size_t length, double t, view<const double> y, view<double> target)
    {
        if (y.size() != dim_ || target.size() != length) {
            throw std::invalid_argument("a kernel of dimension " + std::to_string(dim_) + " was given " +
                                        std::to_string(y.size()) + " numbers, and room for " +
                                        std::to_string(target.size()));
        }
        catching thrown;
        const int code = of(t, y.data(), target.data(), get());
        thrown.rethrow();
        return code;
    }

    handle handle_{};
    std::size_t dim_;
};

} // namespace pc

#endif // PC_KERNEL_HPP
