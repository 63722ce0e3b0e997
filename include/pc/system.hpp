// Equations of motion.

#ifndef PC_SYSTEM_HPP
#define PC_SYSTEM_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../pc.h"
#include "call.hpp"
#include "code.hpp"
#include "force.hpp"
#include "model.hpp"
#include "view.hpp"

namespace pc {
namespace detail {
struct told_elsewhere;
}

/// The entries of ∂f/∂y that may be nonzero, in compressed columns: the rows of column j are
/// row_indices from column_starts[j] up to, but not including, column_starts[j + 1]. It belongs to
/// the system and its copies.
struct sparsity {
    view<const std::size_t> column_starts, row_indices;
};

/// Where a body is: the position of one of its points along fixed axes, and its rotation from its own axes to the fixed
/// ones, column-major.
struct pose {
    std::array<double, 3> position;
    std::array<double, 9> rotation;
};

/// The equations near a state, δẏ = A δy + B δu, δh = C δy + D δu, column-major: u are all external forces, then the
/// parameters that were chosen, h the observables.
struct linear_equations {
    vector a, b, c, d;
};

/// C source: the text of a header, and that of the source file.
struct c_source {
    std::string header, source;
};

/// Equations of motion, compiled: ẏ = f(t, y). Matrices are column-major.
///
/// Functions that are evaluated in loops can write to existing arrays.
class system {
public:
    explicit system(const model &of, pc_form form = PC_POINCARE, const limits &within = {})
    {
        const pc_system_options options = detail::options(form, within);
        detail::call(pc_system_new, of.get(), &options, handle_.place());
    }
    /// With the values of the model, for one thread; nothing is derived.
    explicit system(const code &of) : handle_(detail::make<handle>(pc_system_of_code, of.get())) {}
    /// A copy for another thread. Both call the same force functions.
    system clone() const
    {
        return system(detail::make<handle>(pc_system_clone, get()), forces_);
    }

    /// The length of the state: coordinates, quasi-velocities or momenta, first-order states.
    std::size_t dim() const noexcept { return pc_system_dim(get()); }
    std::size_t coordinate_count() const noexcept { return pc_system_coordinate_count(get()); }
    /// First-order states, which come last.
    std::size_t state_count() const noexcept { return pc_system_state_count(get()); }
    std::size_t parameter_count() const noexcept { return pc_system_parameter_count(get()); }
    std::size_t observable_count() const noexcept { return pc_system_observable_count(get()); }
    /// The number of observables that should stay constant, which come first.
    std::size_t conserved_count() const noexcept { return pc_system_conserved_count(get()); }
    std::size_t constraint_count() const noexcept { return pc_system_constraint_count(get()); }
    std::size_t reaction_count() const noexcept { return pc_system_reaction_count(get()); }
    std::size_t force_count() const noexcept { return pc_system_force_count(get()); }
    std::size_t event_count() const noexcept { return pc_system_event_count(get()); }

    std::vector<std::string> names() const { return list(pc_system_name, dim()); }
    std::vector<std::string> parameter_names() const { return list(pc_system_parameter_name, parameter_count()); }
    std::vector<std::string> observable_names() const
    {
        return list(pc_system_observable_name, observable_count());
    }
    std::vector<std::string> constraint_names() const
    {
        return list(pc_system_constraint_name, constraint_count());
    }
    std::vector<std::string> reaction_names() const { return list(pc_system_reaction_name, reaction_count()); }
    std::vector<std::string> force_names() const { return list(pc_system_force_name, force_count()); }
    std::vector<std::string> event_names() const { return list(pc_system_event_name, event_count()); }

    /// The index of a component of the state, of a parameter and of an observable, by name.
    std::size_t find(const std::string &name) const { return place(pc_system_find, name); }
    std::size_t find_parameter(const std::string &name) const { return place(pc_system_find_parameter, name); }
    std::size_t find_observable(const std::string &name) const { return place(pc_system_find_observable, name); }

    pc_direction event_direction(std::size_t event) const noexcept
    {
        return static_cast<pc_direction>(pc_system_event_direction(get(), event));
    }
    bool event_is_terminal(std::size_t event) const noexcept { return pc_system_event_is_terminal(get(), event); }
    bool event_resets(std::size_t event) const noexcept { return pc_system_event_resets(get(), event); }

    /// The time at which the model starts, and its state.
    std::pair<double, vector> start() const
    {
        std::pair<double, vector> start(0.0, vector(dim()));
        detail::call(pc_system_start, get(), &start.first, start.second.data(), start.second.size());
        return start;
    }
    /// The absolute tolerance of each component with which the program `pc` would run the system to t_end.
    vector absolute_tolerances(double relative, double t_end) const
    {
        vector values(dim());
        detail::call(pc_system_absolute_tolerances, get(), relative, t_end, values.data(), values.size());
        return values;
    }
    /// The derivative of the state at the start with respect to a parameter.
    vector start_by_parameter(std::size_t parameter) const
    {
        vector column(dim());
        detail::call(pc_system_start_by_parameter, get(), parameter, column.data(), column.size());
        return column;
    }
    vector parameters() const
    {
        vector values(parameter_count());
        detail::call(pc_system_parameters, get(), values.data(), values.size());
        return values;
    }
    void set_parameters(view<const double> values)
    {
        detail::call(pc_system_set_parameters, get(), values.data(), values.size());
    }
    void set_parameter(std::size_t index, double value)
    {
        detail::call(pc_system_set_parameter, get(), index, value);
    }

    /// Sets the function that computes the external forces and, if given, the one for their
    /// derivatives, which are otherwise difference quotients. Copies, solvers and kernels made from
    /// now on share the functions; used on several threads, they call them there.
    ///
    /// An exception ends the call that called the functions, whether of the system, a copy, a
    /// solver or a kernel, and comes out there. See catching for calls in C, and run_ensemble,
    /// whose members run on other threads.
    void set_force(force_function function, force_jacobian jacobian = nullptr)
    {
        const auto forces =
            std::make_shared<const detail::forces>(detail::forces{std::move(function), std::move(jacobian)});
        detail::set_force(get(), forces);
        forces_ = forces;
    }

    vector rhs(double t, view<const double> y) { return at(pc_system_rhs, dim(), t, y); }
    void rhs(double t, view<const double> y, view<double> ydot) { to(ydot, pc_system_rhs, t, y); }

    vector jacobian(double t, view<const double> y) { return at(pc_system_jacobian, dim() * dim(), t, y); }
    void jacobian(double t, view<const double> y, view<double> matrix) { to(matrix, pc_system_jacobian, t, y); }

    sparsity jacobian_pattern() const
    {
        std::size_t entries = 0;
        const std::size_t *column_starts = nullptr, *row_indices = nullptr;
        detail::call(pc_system_jacobian_pattern, get(), &entries, &column_starts, &row_indices);
        return {{column_starts, dim() + 1}, {row_indices, entries}};
    }
    /// The entries of the pattern, in its order.
    vector sparse_jacobian(double t, view<const double> y)
    {
        return at(pc_system_sparse_jacobian, jacobian_pattern().row_indices.size(), t, y);
    }
    void sparse_jacobian(double t, view<const double> y, view<double> values)
    {
        to(values, pc_system_sparse_jacobian, t, y);
    }

    /// (∂f/∂y) v
    vector jvp(double t, view<const double> y, view<const double> v)
    {
        return at(pc_system_jvp, dim(), t, y, v.data(), v.size());
    }
    void jvp(double t, view<const double> y, view<const double> v, view<double> product)
    {
        to(product, pc_system_jvp, t, y, v.data(), v.size());
    }

    /// ∂f/∂p; see model::differentiate().
    vector parameter_jacobian(double t, view<const double> y)
    {
        return at(pc_system_parameter_jacobian, dim() * parameter_count(), t, y);
    }
    void parameter_jacobian(double t, view<const double> y, view<double> matrix)
    {
        to(matrix, pc_system_parameter_jacobian, t, y);
    }

    /// ∂f/∂t
    vector time_derivative(double t, view<const double> y) { return at(pc_system_time_derivative, dim(), t, y); }
    void time_derivative(double t, view<const double> y, view<double> derivative)
    {
        to(derivative, pc_system_time_derivative, t, y);
    }

    /// F(t, y, ẏ), which vanishes on motions.
    vector residual(double t, view<const double> y, view<const double> ydot)
    {
        return at(pc_system_residual, dim(), t, y, ydot.data(), ydot.size());
    }
    void residual(double t, view<const double> y, view<const double> ydot, view<double> residual)
    {
        to(residual, pc_system_residual, t, y, ydot.data(), ydot.size());
    }

    vector observe(double t, view<const double> y) { return at(pc_system_observe, observable_count(), t, y); }
    void observe(double t, view<const double> y, view<double> values) { to(values, pc_system_observe, t, y); }

    /// The integrals and the energy, the first of the observables.
    vector integrals(double t, view<const double> y) { return at(pc_system_integrals, conserved_count(), t, y); }
    void integrals(double t, view<const double> y, view<double> values) { to(values, pc_system_integrals, t, y); }

    /// ∂h/∂y of the observables h.
    vector observable_jacobian(double t, view<const double> y)
    {
        return at(pc_system_observable_jacobian, observable_count() * dim(), t, y);
    }
    void observable_jacobian(double t, view<const double> y, view<double> matrix)
    {
        to(matrix, pc_system_observable_jacobian, t, y);
    }
    /// ∂h/∂p of the observables h by all parameters.
    vector observable_parameter_jacobian(double t, view<const double> y)
    {
        return at(pc_system_observable_parameter_jacobian, observable_count() * parameter_count(), t, y);
    }
    /// The equations near (t, y), with the external forces and the parameters with the indices `inputs` as u. The values of the
    /// forces are given, or those of the function that was set.
    linear_equations linearize(double t, view<const double> y, view<const double> forces = {},
                               const std::vector<std::size_t> &inputs = {})
    {
        const std::size_t rows = observable_count(), columns = force_count() + inputs.size();
        linear_equations near{vector(dim() * dim()), vector(dim() * columns), vector(rows * dim()),
                              vector(rows * columns)};
        detail::call(pc_system_linearize, get(), t, y.data(), y.size(), forces.data(), forces.size(), inputs.data(),
                     inputs.size(), near.a.data(), near.a.size(), near.b.data(), near.b.size(), near.c.data(),
                     near.c.size(), near.d.data(), near.d.size());
        return near;
    }

    vector reactions(double t, view<const double> y) { return at(pc_system_reactions, reaction_count(), t, y); }
    void reactions(double t, view<const double> y, view<double> values) { to(values, pc_system_reactions, t, y); }

    /// The functions of the events, which pass through zero where these occur.
    vector events(double t, view<const double> y) { return at(pc_system_events, event_count(), t, y); }
    void events(double t, view<const double> y, view<double> values) { to(values, pc_system_events, t, y); }

    /// Turns the state before an event into the one after it.
    void reset(std::size_t event, double t, view<double> y)
    {
        detail::call(pc_system_event_reset, get(), event, t, y.data(), y.size());
    }
    /// Makes project() keep the integrals of model::keep() at their values at (t, y).
    void keep_from(double t, view<const double> y)
    {
        detail::call(pc_system_keep_from, get(), t, y.data(), y.size());
    }
    /// Projects the state onto the constraints and the values of the kept integrals.
    void project(double t, view<double> y)
    {
        detail::call(pc_system_project, get(), t, y.data(), y.size());
    }
    /// The residual of each constraint.
    vector constraint_residuals(double t, view<const double> y)
    {
        return at(pc_system_constraint_residuals, constraint_count(), t, y);
    }

    double energy(double t, view<const double> y)
    {
        double energy = 0.0;
        detail::call(pc_system_energy, get(), t, y.data(), y.size(), &energy);
        return energy;
    }
    /// The Poisson bracket of two expressions.
    double bracket(const std::string &f, const std::string &g, double t, view<const double> y)
    {
        double value = 0.0;
        detail::call(pc_system_bracket, get(), f.c_str(), g.c_str(), t, y.data(), y.size(), &value);
        return value;
    }
    vector mass_matrix(double t, view<const double> y)
    {
        const std::size_t k = dim() - coordinate_count() - state_count();
        return at(pc_system_mass_matrix, k * k, t, y);
    }
    /// M⁻¹ v
    vector solve_mass_matrix(double t, view<const double> y, view<const double> v)
    {
        return at(pc_system_solve_mass_matrix, dim() - coordinate_count() - state_count(), t, y, v.data(), v.size());
    }
    /// The forces that have to be added for accelerations of the quasi-velocities.
    vector inverse_dynamics(double t, view<const double> y, view<const double> accelerations)
    {
        return at(pc_system_inverse_dynamics, dim() - coordinate_count() - state_count(), t, y,
                  accelerations.data(), accelerations.size());
    }
    /// C, column-major: C η are the terms of M η̇ + h = Q that are quadratic in η.
    vector coriolis(double t, view<const double> y)
    {
        const std::size_t k = dim() - coordinate_count() - state_count();
        return at(pc_system_coriolis, k * k, t, y);
    }
    /// The centroidal momentum matrix A, a and r, column-major, 6 × (k + 2): (P, L) = A η + a, with the rates A η̇ + r.
    vector centroidal(double t, view<const double> y)
    {
        return at(pc_system_centroidal, 6 * (dim() - coordinate_count() - state_count() + 2), t, y);
    }
    vector centre_of_mass(double t, view<const double> y) { return at(pc_system_centre_of_mass, 3, t, y); }
    /// J, a and r, column-major, 3 × (k + 2): the mass centre has the velocity J η + a and the acceleration J η̇ + r.
    vector centre_of_mass_jacobian(double t, view<const double> y)
    {
        return at(pc_system_centre_of_mass_jacobian, 3 * (dim() - coordinate_count() - state_count() + 2), t, y);
    }
    /// J, a and r, column-major, 6 × (k + 2), of a point given along the axes of a body, from its origin: (v, ω) = J η + a,
    /// with the rates J η̇ + r.
    vector body_jacobian(double t, view<const double> y, const std::string &body,
                         const std::array<double, 3> &point = {})
    {
        return at(pc_system_body_jacobian, 6 * (dim() - coordinate_count() - state_count() + 2), t, y, body.c_str(),
                  point.data(), point.size());
    }
    /// The pose of a body, and of a point given along its axes, from its origin.
    pose body_pose(double t, view<const double> y, const std::string &body, const std::array<double, 3> &point = {})
    {
        const vector all = at(pc_system_body_pose, 12, t, y, body.c_str(), point.data(), point.size());
        pose found{};
        std::copy_n(all.begin(), 3, found.position.begin());
        std::copy_n(all.begin() + 3, 9, found.rotation.begin());
        return found;
    }
    /// What the accelerations (v̇, ω̇) of a point of a body have besides J η̇: J̇ η where nothing depends on t.
    vector body_bias(double t, view<const double> y, const std::string &body, const std::array<double, 3> &point = {})
    {
        return at(pc_system_body_bias, 6, t, y, body.c_str(), point.data(), point.size());
    }
    /// The forces that hold the system at rest where it is, against weight and springs.
    vector gravity(double t, view<const double> y)
    {
        return at(pc_system_gravity, dim() - coordinate_count() - state_count(), t, y);
    }
    /// r of M η̇ = r
    vector right_hand_side(double t, view<const double> y)
    {
        return at(pc_system_right_hand_side, dim() - coordinate_count() - state_count(), t, y);
    }
    /// The number K of operators X_1 … X_K.
    std::size_t operator_count()
    {
        std::size_t operators = 0;
        detail::call(pc_system_operator_count, get(), &operators);
        return operators;
    }
    /// c_rs^m of [X_r, X_s] = c_rs^m X_m, at the index (r*(K + 1) + s)*K + m - 1, for r, s = 0 … K.
    vector structure_coefficients(double t, view<const double> y)
    {
        const std::size_t k = operator_count();
        return at(pc_system_structure_coefficients, (k + 1) * (k + 1) * k, t, y);
    }
    vector to_momenta(double t, view<const double> y) { return at(pc_system_to_momenta, dim(), t, y); }
    vector to_quasi_velocities(double t, view<const double> y)
    {
        return at(pc_system_to_quasi_velocities, dim(), t, y);
    }

    std::string print(pc_format format = PC_TEXT) const { return detail::text(pc_system_print, get(), format); }
    /// The analysis of the motions; integrals have up to this degree in the velocities and these
    /// functions in coefficients.
    std::string theory(pc_format format = PC_TEXT, std::size_t degree = 2,
                       const std::vector<std::string> &functions = {}) const
    {
        std::vector<const char *> texts;
        for (const std::string &function : functions)
            texts.push_back(function.c_str());
        return detail::text(pc_system_theory, get(), format, degree, texts.data(), texts.size());
    }
    /// The test of functions as canonical variables: pairs of a name and an expression, first the new
    /// coordinates, then as many new momenta.
    std::string canonical_variables(const std::vector<std::pair<std::string, std::string>> &proposed,
                                    pc_format format = PC_TEXT) const
    {
        std::vector<const char *> names, functions;
        for (const auto &[name, function] : proposed) {
            names.push_back(name.c_str());
            functions.push_back(function.c_str());
        }
        return detail::text(pc_system_canonical_variables, get(), format, names.data(), functions.data(),
                            names.size());
    }
    /// How closely the equations agree with a second derivation, at random states; throws if they
    /// do not.
    std::string verify(std::size_t states = 100) const { return detail::text(pc_system_verify, get(), states); }
    /// The same at one state, such as that of a solver.
    std::string verify_at(double t, const std::vector<double> &y) const
    {
        return detail::text(pc_system_verify_at, get(), t, y.data(), y.size());
    }
    /// The equations as C source, which with -DNAME_MAIN is a program that integrates to t_end, if that is finite.
    c_source emit_c(const std::string &name, double t_end = std::numeric_limits<double>::infinity()) const
    {
        detail::owned<char, pc_string_free> header, source;
        detail::call(pc_system_emit_c, get(), name.c_str(), t_end, header.place(), source.place());
        return {header.get(), source.get()};
    }
    pc_system *get() const noexcept { return handle_.get(); }

private:
    friend struct detail::told_elsewhere;
    using handle = detail::owned<pc_system, pc_system_free>;

    system(handle made, std::shared_ptr<const detail::forces> forces)
        : handle_(std::move(made)), forces_(std::move(forces))
    {
    }
    template <class Name> std::vector<std::string> list(Name name, std::size_t count) const
    {
        return detail::names(get(), name, count);
    }
    template <class Find> std::size_t place(Find function, const std::string &name) const
    {
        std::size_t index = 0;
        detail::call(function, get(), name.c_str(), &index);
        return index;
    }
    /// Lets a function write its values at (t, y), with further arguments, to the target.
    template <class Function, class... Further>
    void to(view<double> target, Function function, double t, view<const double> y, Further... further)
    {
        detail::call(function, get(), t, y.data(), y.size(), further..., target.data(), target.size());
    }
    template <class Function, class... Further>
    vector at(Function function, std::size_t length, double t, view<const double> y, Further... further)
    {
        vector values(length);
        to(values, function, t, y, further...);
        return values;
    }

    handle handle_{};
    std::shared_ptr<const detail::forces> forces_{};
};

} // namespace pc

#endif // PC_SYSTEM_HPP
