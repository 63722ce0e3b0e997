// Models: a text, or built call by call.

#ifndef PC_MODEL_HPP
#define PC_MODEL_HPP

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../pc.h"
#include "call.hpp"

namespace pc {

/// A model. Expressions are texts. What pc.h says of pc_model_add_... and pc_model_set_... holds for the functions that
/// build it; each returns the model, so that they can be chained.
class model {
public:
    /// The components of a vector, as expressions.
    using components = std::array<std::string, 3>;
    /// The entries of a matrix, row by row.
    using matrix = std::array<std::string, 9>;

    /// An empty model, to be built.
    explicit model(const std::string &name) : handle_(make(pc_model_new, name.c_str())) {}
    static model parse(const std::string &text, const std::string &name = "model")
    {
        return model(make(pc_model_parse, text.data(), text.size(), name.c_str()));
    }
    static model from_file(const std::string &path) { return model(make(pc_model_from_file, path.c_str())); }
    /// A robot in URDF, MJCF or SDF.
    static model from_robot(const std::string &path, bool floating = false, bool fix_massless = false)
    {
        return model(make(pc_model_from_robot, path.c_str(), int(floating), int(fix_massless)));
    }
    /// A model that comes with the library.
    static model builtin(const std::string &name) { return model(make(pc_model_builtin, name.c_str())); }
    static std::vector<std::string> builtin_names()
    {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < pc_builtin_count(); i++) {
            names.emplace_back(pc_builtin_name(i));
        }
        return names;
    }
    model clone() const { return model(make(pc_model_clone, get())); }

    model &description(const std::string &text) { return say(pc_model_set_description, text.c_str()); }
    model &reference(const std::string &text) { return say(pc_model_set_reference, text.c_str()); }
    model &parameter(const std::string &name, double value)
    {
        return say(pc_model_add_parameter, name.c_str(), value);
    }
    /// An expression in the parameters before it.
    model &parameter(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_parameter_expression, name.c_str(), expression.c_str());
    }
    model &input(const std::string &name, double value) { return say(pc_model_add_input, name.c_str(), value); }
    /// An input by its values at times; `interpolation` is "linear", "cubic" or "hold".
    model &input(const std::string &name, const std::vector<double> &times, const std::vector<double> &values,
                 const std::string &interpolation = "linear")
    {
        if (times.size() != values.size()) {
            throw std::invalid_argument("an input needs as many times as values");
        }
        return say(pc_model_add_input_table, name.c_str(), times.data(), values.data(), times.size(),
                   interpolation.c_str());
    }
    /// An input by its values and rates at times, and perhaps its accelerations: a smooth function, which may move
    /// positions and constraints.
    model &input_curve(const std::string &name, const std::vector<double> &times, const std::vector<double> &values,
                       const std::vector<double> &rates, const std::vector<double> &accelerations = {})
    {
        const std::size_t length = times.size();
        if (values.size() != length || rates.size() != length ||
            (!accelerations.empty() && accelerations.size() != length)) {
            throw std::invalid_argument("an input needs as many values, rates and accelerations as times");
        }
        return say(pc_model_add_input_curve, name.c_str(), times.data(), values.data(), rates.data(),
                   accelerations.empty() ? nullptr : accelerations.data(), length);
    }
    /// An input by a column of a file.
    model &input_file(const std::string &name, const std::string &path, const std::string &column,
                      const std::string &interpolation = "linear")
    {
        return say(pc_model_add_input_file, name.c_str(), path.c_str(), column.c_str(), nullptr,
                   interpolation.c_str());
    }
    /// An input by the columns of values, rates and, unless empty, accelerations of a file.
    model &input_curve_file(const std::string &name, const std::string &path, const std::string &column,
                            const std::string &rate, const std::string &acceleration = "")
    {
        return say(pc_model_add_input_curve_file, name.c_str(), path.c_str(), column.c_str(), rate.c_str(),
                   acceleration.empty() ? nullptr : acceleration.c_str(), nullptr);
    }
    model &definition(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_definition, name.c_str(), expression.c_str());
    }

    model &coordinate(const std::string &name, double start)
    {
        return say(pc_model_add_coordinate, name.c_str(), start);
    }
    /// A first-order state.
    model &state(const std::string &name, const std::string &rate, double start)
    {
        return say(pc_model_add_state, name.c_str(), rate.c_str(), start);
    }
    model &gravity(const components &acceleration)
    {
        return say(pc_model_set_gravity, acceleration[0].c_str(), acceleration[1].c_str(), acceleration[2].c_str());
    }
    model &quasi_velocity(const std::string &name, double start)
    {
        return say(pc_model_add_quasi_velocity, name.c_str(), nullptr, start);
    }
    model &quasi_velocity(const std::string &name, const std::string &definition, double start)
    {
        return say(pc_model_add_quasi_velocity, name.c_str(), definition.c_str(), start);
    }
    model &kinematics(const std::string &coordinate, const std::string &velocity)
    {
        return say(pc_model_set_kinematics, coordinate.c_str(), velocity.c_str());
    }
    model &algebra(const std::string &name) { return say(pc_model_set_algebra, name.c_str()); }
    model &bracket(const std::string &left, const std::string &right, const std::string &value)
    {
        return say(pc_model_set_bracket, left.c_str(), right.c_str(), value.c_str());
    }
    model &constraint(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_constraint, name.c_str(), expression.c_str());
    }
    model &constraint_kind(const std::string &constraint, const std::string &kind)
    {
        return say(pc_model_set_constraint_kind, constraint.c_str(), kind.c_str());
    }

    model &lagrangian(const std::string &expression) { return say(pc_model_set_lagrangian, expression.c_str()); }
    model &kinetic(const std::string &expression) { return say(pc_model_set_kinetic, expression.c_str()); }
    model &potential(const std::string &expression) { return say(pc_model_set_potential, expression.c_str()); }
    model &dissipation(const std::string &expression)
    {
        return say(pc_model_set_dissipation, expression.c_str());
    }
    model &force(const std::string &on, const std::string &expression)
    {
        return say(pc_model_add_force, on.c_str(), expression.c_str());
    }
    /// Gives a quasi-velocity by a linear form in velocities, for PC_HAMEL.
    model &give_quasi_velocity(const std::string &name, const std::string &definition)
    {
        return say(pc_model_give_quasi_velocity, name.c_str(), definition.c_str());
    }

    /// Chooses a velocity as one of the independent ones.
    model &independent(const std::string &name) { return say(pc_model_add_independent, name.c_str()); }

    /// A force that a function will compute: system::set_force.
    model &external_force(const std::string &on) { return say(pc_model_add_external_force, on.c_str()); }

    model &body(const std::string &name, const std::string &mass, const components &position)
    {
        return of_body(pc_model_add_body, name, position, mass.c_str());
    }
    model &body_force(const std::string &body, const components &force)
    {
        return of_body(pc_model_set_body_force, body, force);
    }
    model &body_torque(const std::string &body, const components &torque)
    {
        return of_body(pc_model_set_body_torque, body, torque);
    }
    model &body_angular_velocity(const std::string &body, const components &velocity)
    {
        return of_body(pc_model_set_body_angular_velocity, body, velocity);
    }
    /// Three entries or six.
    model &body_inertia(const std::string &body, const std::vector<std::string> &entries)
    {
        return entries_of_body(pc_model_set_body_inertia, body, entries);
    }
    model &body_rotation(const std::string &body, const matrix &entries)
    {
        return entries_of_body(pc_model_set_body_rotation, body, entries);
    }

    /// A body that hangs on another by a joint, on the world if `parent` is empty.
    model &jointed_body(const std::string &name, const std::string &parent, const std::string &kind)
    {
        return say(pc_model_add_jointed_body, name.c_str(), parent.empty() ? nullptr : parent.c_str(),
                   kind.c_str());
    }
    model &body_mass(const std::string &body, const std::string &mass)
    {
        return say(pc_model_set_body_mass, body.c_str(), mass.c_str());
    }
    model &body_center(const std::string &body, const components &center)
    {
        return of_body(pc_model_set_body_center, body, center);
    }
    model &joint_place(const std::string &body, const components &place)
    {
        return of_body(pc_model_set_joint_place, body, place);
    }
    model &joint_axis(const std::string &body, const std::array<double, 3> &axis)
    {
        return say(pc_model_set_joint_axis, body.c_str(), axis.data());
    }
    /// The axes of a universal joint.
    model &joint_axes(const std::string &body, const std::array<double, 3> &first,
                      const std::array<double, 3> &second)
    {
        return say(pc_model_set_joint_axes, body.c_str(), first.data(), second.data());
    }
    model &joint_pitch(const std::string &body, const std::string &pitch)
    {
        return say(pc_model_set_joint_pitch, body.c_str(), pitch.c_str());
    }
    /// Gears a joint to that of another body, by x = ratio x of the other + offset.
    model &joint_gear(const std::string &body, const std::string &followed, const std::string &ratio = "1",
                      const std::string &offset = "0")
    {
        return say(pc_model_set_joint_gear, body.c_str(), followed.c_str(), ratio.c_str(), offset.c_str());
    }
    model &joint_armature(const std::string &body, const std::string &armature)
    {
        return say(pc_model_set_joint_armature, body.c_str(), armature.c_str());
    }
    model &joint_spring(const std::string &body, const std::string &stiffness, const std::string &rest = "0")
    {
        return say(pc_model_set_joint_spring, body.c_str(), stiffness.c_str(), rest.c_str());
    }
    model &joint_damping(const std::string &body, const std::string &damping)
    {
        return say(pc_model_set_joint_damping, body.c_str(), damping.c_str());
    }
    model &joint_friction(const std::string &body, const std::string &friction)
    {
        return say(pc_model_set_joint_friction, body.c_str(), friction.c_str());
    }
    /// Stops at the ends of the way of a joint.
    model &joint_limits(const std::string &body, const std::string &lower, const std::string &upper,
                        const std::string &stiffness, const std::string &damping = "0")
    {
        return say(pc_model_set_joint_limits, body.c_str(), lower.c_str(), upper.c_str(), stiffness.c_str(),
                   damping.c_str());
    }
    /// Rigid stops at the ends of the way of a joint, with this coefficient of restitution.
    model &joint_restitution(const std::string &body, const std::string &lower, const std::string &upper,
                             const std::string &restitution)
    {
        return say(pc_model_set_joint_restitution, body.c_str(), lower.c_str(), upper.c_str(),
                   restitution.c_str());
    }
    /// The force up to which the friction of a joint holds it at rest.
    model &joint_stiction(const std::string &body, const std::string &stiction)
    {
        return say(pc_model_set_joint_stiction, body.c_str(), stiction.c_str());
    }
    model &joint_rotation(const std::string &body, const matrix &entries)
    {
        return entries_of_body(pc_model_set_joint_rotation, body, entries);
    }
    /// Turns about axes, a letter and an angle each.
    model &joint_turns(const std::string &body, const std::string &axes, const std::vector<std::string> &angles)
    {
        const std::vector<const char *> texts = of_texts(angles);
        return say(pc_model_set_joint_turns, body.c_str(), axes.c_str(), texts.data(), texts.size());
    }
    model &joint_coordinates(const std::string &body, const std::vector<std::string> &names)
    {
        return entries_of_body(pc_model_name_joint_coordinates, body, names);
    }
    model &joint_quasi_velocities(const std::string &body, const std::vector<std::string> &names)
    {
        return entries_of_body(pc_model_name_joint_quasi_velocities, body, names);
    }
    model &point(const std::string &name, const std::string &body, const components &place)
    {
        return say(pc_model_add_point, name.c_str(), body.c_str(), place[0].c_str(), place[1].c_str(),
                   place[2].c_str());
    }
    /// Closes a loop by joining two bodies at a point of each.
    model &loop(const std::string &name, const std::string &kind, const std::string &first,
                const std::string &second, const components &here, const components &there)
    {
        const std::array<const char *, 6> places{here[0].c_str(),  here[1].c_str(),  here[2].c_str(),
                                                 there[0].c_str(), there[1].c_str(), there[2].c_str()};
        return say(pc_model_add_loop, name.c_str(), kind.c_str(), first.c_str(), second.c_str(),
                   places.data());
    }
    model &loop_axes(const std::string &name, const std::array<double, 3> &first,
                     const std::array<double, 3> &second)
    {
        return say(pc_model_set_loop_axes, name.c_str(), first.data(), second.data());
    }
    model &loop_length(const std::string &name, const std::string &length)
    {
        return say(pc_model_set_loop_length, name.c_str(), length.c_str());
    }
    /// Adds a contact of a body with a plane or uneven ground.
    model &contact(const std::string &name, const std::string &body, const std::string &shape,
                   const std::string &motion)
    {
        return say(pc_model_add_contact, name.c_str(), body.c_str(), shape.c_str(), motion.c_str());
    }
    model &contact_entry(const std::string &name, const std::string &entry,
                         const std::vector<std::string> &values)
    {
        const std::vector<const char *> texts = of_texts(values);
        return say(pc_model_set_contact, name.c_str(), entry.c_str(), texts.data(), texts.size());
    }

    model &integral(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_integral, name.c_str(), expression.c_str());
    }
    model &output(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_output, name.c_str(), expression.c_str());
    }
    model &action(const std::string &expression) { return say(pc_model_set_action, expression.c_str()); }
    model &action_constant(const std::string &name, double value)
    {
        return say(pc_model_add_action_constant, name.c_str(), value);
    }
    model &event(const std::string &name, const std::string &when, pc_direction direction = PC_BOTH,
                 bool terminal = false)
    {
        return say(pc_model_add_event, name.c_str(), when.c_str(), direction, terminal);
    }
    model &event_reset(const std::string &event, const std::string &variable, const std::string &expression)
    {
        return say(pc_model_add_event_reset, event.c_str(), variable.c_str(), expression.c_str());
    }

    /// Sets a parameter to another value.
    model &set(const std::string &parameter, double value)
    {
        return say(pc_model_set, parameter.c_str(), value);
    }
    model &start(const std::string &name, double value) { return say(pc_model_set_start, name.c_str(), value); }
    model &start(const std::string &name, const std::string &expression)
    {
        return say(pc_model_set_start_expression, name.c_str(), expression.c_str());
    }
    model &start_time(double t) { return say(pc_model_set_start_time, t); }
    model &keep(const std::string &integral) { return say(pc_model_keep, integral.c_str()); }
    model &project_start(bool yes = true) { return say(pc_model_project_start, yes); }
    model &hold_start(const std::string &name) { return say(pc_model_hold_start, name.c_str()); }
    model &observe_reactions(bool yes = true) { return say(pc_model_observe_reactions, yes); }
    model &differentiate(bool yes = true) { return say(pc_model_differentiate, yes); }

    /// How the program `pc` runs the model; solvers take solver_options instead.
    model &end_time(double t) { return say(pc_model_set_end_time, t); }
    model &samples(std::size_t samples) { return say(pc_model_set_samples, samples); }
    model &tolerances(double relative, double absolute)
    {
        return say(pc_model_set_tolerances, relative, absolute);
    }
    model &max_step(double length) { return say(pc_model_set_max_step, length); }
    model &event_search(std::size_t samples_per_step, double accumulation)
    {
        return say(pc_model_set_event_search, samples_per_step, accumulation);
    }
    model &method(const std::string &method) { return say(pc_model_set_method, method.c_str()); }
    model &form(const std::string &form) { return say(pc_model_set_form, form.c_str()); }

    /// Throws unless the whole model is well formed.
    void check() const { detail::call(pc_model_check, get()); }
    std::string text() const { return detail::text(pc_model_text, get()); }
    pc_model *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_model, pc_model_free>;

    explicit model(handle made) : handle_(std::move(made)) {}
    template <class Function, class... Arguments> static handle make(Function function, Arguments... arguments)
    {
        return detail::make<handle>(function, arguments...);
    }
    template <class Function, class... Arguments> model &say(Function function, Arguments... arguments)
    {
        detail::call(function, get(), arguments...);
        return *this;
    }
    template <class Function, class... Arguments>
    model &of_body(Function function, const std::string &body, const components &of, Arguments... arguments)
    {
        return say(function, body.c_str(), arguments..., of[0].c_str(), of[1].c_str(), of[2].c_str());
    }
    template <class Function, class Entries>
    model &entries_of_body(Function function, const std::string &body, const Entries &entries)
    {
        const std::vector<const char *> texts = of_texts(entries);
        return say(function, body.c_str(), texts.data(), texts.size());
    }
    template <class Entries>
    static std::vector<const char *> of_texts(const Entries &entries)
    {
        std::vector<const char *> texts;
        for (const std::string &entry : entries) {
            texts.push_back(entry.c_str());
        }
        return texts;
    }

    handle handle_{};
};

} // namespace pc

#endif // PC_MODEL_HPP
