// Equilibria and steady motions, and the linear equations near them.

#ifndef PC_LINEARIZATION_HPP
#define PC_LINEARIZATION_HPP

#include <complex>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../pc.h"
#include "call.hpp"
#include "system.hpp"
#include "view.hpp"

namespace pc {

/// The linear equations δẋ = A δx + B δu, δh = C δx + D δu about a state near y, in independent components x; u are the external
/// forces, then the parameters that were chosen, h the outputs. Matrices are column-major.
class linearization {
public:
    /// The components with the indices `held` keep their values while a steady state is sought; the values of the forces are
    /// given, or those of the function that was set.
    linearization(const system &of, pc_about about, double t, view<const double> y, view<const double> forces = {},
                  const std::vector<std::size_t> &held = {}, const std::vector<std::size_t> &inputs = {})
        : dim_(of.dim())
    {
        detail::call(pc_system_linearization, of.get(), about, t, y.data(), y.size(), held.data(), held.size(),
                     forces.data(), forces.size(), inputs.data(), inputs.size(), handle_.place());
    }

    std::size_t count(pc_linear_part part) const noexcept { return pc_linearization_count(get(), part); }
    std::vector<std::string> names(pc_linear_part part) const
    {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < count(part); i++) {
            names.emplace_back(pc_linearization_name(get(), part, i));
        }
        return names;
    }
    bool is_steady() const noexcept { return pc_linearization_is_steady(get()); }

    /// The state of the system about which the equations were linearised.
    vector state() const
    {
        vector y(dim_);
        detail::call(pc_linearization_state, get(), y.data(), y.size());
        return y;
    }
    vector a() const { return matrix(PC_LINEAR_A, PC_LINEAR_COMPONENTS, PC_LINEAR_COMPONENTS); }
    vector b() const { return matrix(PC_LINEAR_B, PC_LINEAR_COMPONENTS, PC_LINEAR_INPUTS); }
    vector c() const { return matrix(PC_LINEAR_C, PC_LINEAR_OUTPUTS, PC_LINEAR_COMPONENTS); }
    vector d() const { return matrix(PC_LINEAR_D, PC_LINEAR_OUTPUTS, PC_LINEAR_INPUTS); }
    /// The eigenvalues of A.
    std::vector<std::complex<double>> eigenvalues() const
    {
        const std::size_t r = count(PC_LINEAR_COMPONENTS);
        vector parts(2 * r);
        detail::call(pc_linearization_matrix, get(), PC_LINEAR_EIGENVALUES, parts.data(), parts.size());
        std::vector<std::complex<double>> all;
        for (std::size_t i = 0; i < r; i++) {
            all.emplace_back(parts[i], parts[r + i]);
        }
        return all;
    }
    pc_linearization *get() const noexcept { return handle_.get(); }

private:
    vector matrix(pc_linear_matrix which, pc_linear_part rows, pc_linear_part columns) const
    {
        vector values(count(rows) * count(columns));
        detail::call(pc_linearization_matrix, get(), which, values.data(), values.size());
        return values;
    }

    detail::owned<pc_linearization, pc_linearization_free> handle_{};
    std::size_t dim_;
};

} // namespace pc

#endif // PC_LINEARIZATION_HPP
