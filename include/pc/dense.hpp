// Motions as functions of time.

#ifndef PC_DENSE_HPP
#define PC_DENSE_HPP

#include <cstddef>
#include <utility>

#include "../pc.h"
#include "call.hpp"
#include "view.hpp"

namespace pc {

/// A motion as a function of time, made by solver::run_dense. Any number of threads may use it.
class dense {
public:
    vector operator()(double t) const { return at(pc_dense_eval, t); }
    void operator()(double t, view<double> y) const { to(y, pc_dense_eval, t); }
    vector rate(double t) const { return at(pc_dense_rate, t); }
    void rate(double t, view<double> ydot) const { to(ydot, pc_dense_rate, t); }
    std::size_t dim() const noexcept { return pc_dense_dim(get()); }
    double t_begin() const noexcept { return pc_dense_t_begin(get()); }
    double t_end() const noexcept { return pc_dense_t_end(get()); }
    pc_dense *get() const noexcept { return handle_.get(); }

private:
    friend class solver;
    using handle = detail::owned<pc_dense, pc_dense_free>;

    explicit dense(handle made) : handle_(std::move(made)) {}
    template <class Function> void to(view<double> target, Function function, double t) const
    {
        detail::call(function, get(), t, target.data(), target.size());
    }
    template <class Function> vector at(Function function, double t) const
    {
        vector values(dim());
        to(values, function, t);
        return values;
    }

    handle handle_{};
};

} // namespace pc

#endif // PC_DENSE_HPP
