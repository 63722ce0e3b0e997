// pc for C++17: the handles of pc.h as objects that free themselves, errors as exceptions, arrays as vectors.
//
// Objects move and do not copy, but for what has a clone(). What pc.h says of threads holds here.

#ifndef PC_HPP
#define PC_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pc.h"

namespace pc {

/// A call that failed; what() is the message.
class error : public std::runtime_error {
public:
    explicit error(pc_status status, const pc_error *from)
        : std::runtime_error(from ? pc_error_message(from) : pc_status_name(status)),
          status_(status),
          line_(pc_error_line(from)),
          column_(pc_error_column(from)),
          integrator_code_(pc_error_integrator_code(from))
    {
    }

    pc_status status() const noexcept { return status_; }
    /// The place in the model text, from 1; 0 if there is none.
    std::size_t line() const noexcept { return line_; }
    std::size_t column() const noexcept { return column_; }
    /// The code of CVODES, or 0.
    int integrator_code() const noexcept { return integrator_code_; }

private:
    pc_status status_;
    std::size_t line_, column_;
    int integrator_code_;
};

namespace detail {

template <class Handle, void (*Free)(Handle *)> struct deleter {
    void operator()(Handle *handle) const noexcept { Free(handle); }
};

template <class Handle, void (*Free)(Handle *)> using owned = std::unique_ptr<Handle, deleter<Handle, Free>>;

inline void check(pc_status status, pc_error *raw)
{
    const owned<pc_error, pc_error_free> from(raw);
    if (status != PC_OK && status != PC_STOPPED && status != PC_EVENT) {
        throw error(status, raw);
    }
}

/// Calls a function with the place of its error last.
template <class Function, class... Arguments> pc_status call(Function function, Arguments... arguments)
{
    pc_error *from = nullptr;
    const pc_status status = function(arguments..., &from);
    check(status, from);
    return status;
}

/// The text that a function gives.
template <class Function, class... Arguments> std::string text(Function function, Arguments... arguments)
{
    char *raw = nullptr;
    call(function, arguments..., &raw);
    const owned<char, pc_string_free> given(raw);
    return given.get();
}

/// The row, if it has as many numbers as it should.
inline const std::vector<double> &sized(const std::vector<double> &row, std::size_t width, const char *what)
{
    if (row.size() != width) {
        throw std::invalid_argument(std::string(what) + " has " + std::to_string(row.size()) + " numbers, but there are "
                                    + std::to_string(width));
    }
    return row;
}

} // namespace detail

/// A model: a text, or what is said call by call.
class model {
public:
    /// Without anything, to be built.
    explicit model(const std::string &name) : handle_(make(pc_model_new, name.c_str())) {}
    static model parse(const std::string &text, const std::string &name = "model")
    {
        return model(make(pc_model_parse, text.data(), text.size(), name.c_str()));
    }
    static model from_file(const std::string &path) { return model(make(pc_model_from_file, path.c_str())); }
    static model builtin(const std::string &name) { return model(make(pc_model_builtin, name.c_str())); }
    model clone() const { return model(make(pc_model_clone, static_cast<const pc_model *>(get()))); }

    model &parameter(const std::string &name, double value)
    {
        return say(pc_model_add_parameter, name.c_str(), value);
    }
    model &definition(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_definition, name.c_str(), expression.c_str());
    }
    model &coordinate(const std::string &name, double start)
    {
        return say(pc_model_add_coordinate, name.c_str(), start);
    }
    model &quasi_velocity(const std::string &name, double start)
    {
        return say(pc_model_add_quasi_velocity, name.c_str(), static_cast<const char *>(nullptr), start);
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
    model &integral(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_integral, name.c_str(), expression.c_str());
    }
    model &output(const std::string &name, const std::string &expression)
    {
        return say(pc_model_add_output, name.c_str(), expression.c_str());
    }

    model &event(const std::string &name, const std::string &when, pc_direction direction = PC_BOTH,
                 bool terminal = false)
    {
        return say(pc_model_add_event, name.c_str(), when.c_str(), static_cast<int>(direction), terminal ? 1 : 0);
    }
    model &event_reset(const std::string &event, const std::string &variable, const std::string &expression)
    {
        return say(pc_model_add_event_reset, event.c_str(), variable.c_str(), expression.c_str());
    }

    model &set(const std::string &parameter, double value)
    {
        return say(pc_model_set, parameter.c_str(), value);
    }
    model &keep(const std::string &integral) { return say(pc_model_keep, integral.c_str()); }
    model &project_start(bool yes = true) { return say(pc_model_project_start, yes ? 1 : 0); }
    model &observe_reactions(bool yes = true) { return say(pc_model_observe_reactions, yes ? 1 : 0); }

    std::string text() const { return detail::text(pc_model_text, static_cast<const pc_model *>(get())); }
    pc_model *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_model, pc_model_free>;

    explicit model(handle made) : handle_(std::move(made)) {}
    template <class Function, class... Arguments> static handle make(Function function, Arguments... arguments)
    {
        pc_model *raw = nullptr;
        detail::call(function, arguments..., &raw);
        return handle(raw);
    }
    template <class Function, class... Arguments> model &say(Function function, Arguments... arguments)
    {
        detail::call(function, get(), arguments...);
        return *this;
    }

    handle handle_;
};

using vector = std::vector<double>;

/// Equations of motion, compiled.
class system {
public:
    explicit system(const model &of, pc_form form = PC_POINCARE)
    {
        pc_system_options options;
        pc_system_options_init(&options, sizeof options);
        options.form = form;
        pc_system *raw = nullptr;
        detail::call(pc_system_new, static_cast<const pc_model *>(of.get()),
                     static_cast<const pc_system_options *>(&options), &raw);
        handle_.reset(raw);
    }
    /// A copy for another thread.
    system clone() const
    {
        pc_system *raw = nullptr;
        detail::call(pc_system_clone, static_cast<const pc_system *>(get()), &raw);
        return system(raw);
    }

    std::size_t dim() const noexcept { return pc_system_dim(get()); }
    std::size_t coordinates() const noexcept { return pc_system_coordinate_count(get()); }
    std::vector<std::string> names() const { return list(pc_system_name, dim()); }
    std::vector<std::string> parameter_names() const
    {
        return list(pc_system_parameter_name, pc_system_parameter_count(get()));
    }
    std::vector<std::string> observable_names() const
    {
        return list(pc_system_observable_name, pc_system_observable_count(get()));
    }
    /// The state from which the model starts, and its time.
    std::pair<double, vector> start() const
    {
        std::pair<double, vector> start(0.0, vector(dim()));
        detail::call(pc_system_start, static_cast<const pc_system *>(get()), &start.first,
                     start.second.data(), dim());
        return start;
    }
    vector parameters() const
    {
        vector values(pc_system_parameter_count(get()));
        detail::call(pc_system_parameters, static_cast<const pc_system *>(get()), values.data(),
                     values.size());
        return values;
    }
    void set_parameters(const vector &values)
    {
        detail::call(pc_system_set_parameters, get(), values.data(), values.size());
    }

    vector rhs(double t, const vector &y) { return at(pc_system_rhs, t, y, dim()); }
    /// Column-major.
    vector jacobian(double t, const vector &y) { return at(pc_system_jacobian, t, y, dim() * dim()); }
    /// Column-major.
    vector mass_matrix(double t, const vector &y)
    {
        const std::size_t k = dim() - coordinates();
        return at(pc_system_mass_matrix, t, y, k * k);
    }
    vector observe(double t, const vector &y)
    {
        return at(pc_system_observe, t, y, pc_system_observable_count(get()));
    }
    vector reactions(double t, const vector &y)
    {
        return at(pc_system_reactions, t, y, pc_system_reaction_count(get()));
    }
    std::vector<std::string> event_names() const
    {
        return list(pc_system_event_name, pc_system_event_count(get()));
    }
    /// The functions of the events, which pass through zero where these occur.
    vector events(double t, const vector &y) { return at(pc_system_events, t, y, pc_system_event_count(get())); }
    /// The state after an event.
    vector reset(std::size_t event, double t, vector y)
    {
        detail::call(pc_system_event_reset, get(), event, t, y.data(), y.size());
        return y;
    }
    double energy(double t, const vector &y)
    {
        double energy = 0.0;
        detail::call(pc_system_energy, get(), t, y.data(), y.size(), &energy);
        return energy;
    }
    vector to_momenta(double t, const vector &y) { return at(pc_system_to_momenta, t, y, dim()); }
    vector to_quasi_velocities(double t, const vector &y)
    {
        return at(pc_system_to_quasi_velocities, t, y, dim());
    }
    /// The state moved to the constraints.
    vector project(double t, vector y)
    {
        detail::call(pc_system_project, get(), t, y.data(), y.size());
        return y;
    }
    std::string print(pc_format format = PC_TEXT) const
    {
        return detail::text(pc_system_print, static_cast<const pc_system *>(get()), static_cast<int>(format));
    }
    pc_system *get() const noexcept { return handle_.get(); }

private:
    explicit system(pc_system *raw) : handle_(raw) {}
    template <class Function> vector at(Function function, double t, const vector &y, std::size_t length)
    {
        vector values(length);
        detail::call(function, get(), t, y.data(), y.size(), values.data(), length);
        return values;
    }
    template <class Function> std::vector<std::string> list(Function name, std::size_t count) const
    {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < count; i++) {
            names.emplace_back(name(get(), i));
        }
        return names;
    }

    detail::owned<pc_system, pc_system_free> handle_;
};

/// A motion as a function of time.
class dense {
public:
    vector operator()(double t) const { return at(pc_dense_eval, t); }
    vector rate(double t) const { return at(pc_dense_rate, t); }
    double t_begin() const noexcept { return pc_dense_t_begin(handle_.get()); }
    double t_end() const noexcept { return pc_dense_t_end(handle_.get()); }

private:
    friend class solver;
    explicit dense(pc_dense *raw) : handle_(raw) {}
    template <class Function> vector at(Function function, double t) const
    {
        vector y(pc_dense_dim(handle_.get()));
        detail::call(function, static_cast<const pc_dense *>(handle_.get()), t, y.data(), y.size());
        return y;
    }

    detail::owned<pc_dense, pc_dense_free> handle_;
};

/// An event that occurred, by its number, with the states before and after it.
struct occurrence {
    std::size_t event;
    double t;
    vector before, after;
};

/// The label of a checkpoint.
inline std::string checkpoint_label(const std::vector<unsigned char> &bytes)
{
    return detail::text(pc_checkpoint_label, static_cast<const void *>(bytes.data()), bytes.size());
}

/// An integration, which stands at a time with a state. What a function or observer throws comes out of the call that
/// called it.
class solver {
public:
    using observer = std::function<bool(double t, const vector &y)>;
    using event_observer = std::function<bool(const occurrence &event)>;
    using event_function = std::function<double(double t, const vector &y)>;
    using event_reset = std::function<void(double t, vector &y)>;

    static pc_solver_options default_options()
    {
        pc_solver_options options;
        pc_solver_options_init(&options, sizeof options);
        return options;
    }
    /// From the start of the model.
    explicit solver(const system &of, const pc_solver_options &options = default_options())
        : solver(of, 0.0, nullptr, 0, options)
    {
    }
    /// From the state y at the time t.
    solver(const system &of, double t, const vector &y, const pc_solver_options &options = default_options())
        : solver(of, t, detail::sized(y, of.dim(), "y").data(), y.size(), options)
    {
    }
    /// From a checkpoint.
    static solver restore(const system &of, const std::vector<unsigned char> &bytes,
                          const pc_solver_options &options = default_options())
    {
        pc_solver *raw = nullptr;
        detail::call(pc_solver_restore, static_cast<const pc_system *>(of.get()), &options,
                     static_cast<const void *>(bytes.data()), bytes.size(), &raw);
        return solver(raw, of.dim());
    }

    /// Follows an event of one's own; before the first step.
    void add_event(const std::string &name, pc_direction direction, bool terminal, event_function function,
                   event_reset reset = nullptr)
    {
        auto event = std::make_unique<own_event>(own_event{std::move(function), std::move(reset), thrown_.get()});
        const pc_event_reset forward = event->reset ? &forward_reset : nullptr;
        invoke(pc_solver_add_event, get(), name.c_str(), static_cast<int>(direction), terminal ? 1 : 0,
               &forward_function, forward, static_cast<void *>(event.release()), &destroy_event);
    }
    /// Has `observe` called at each event, until it answers false, which stops the call.
    void observe_events(event_observer observe)
    {
        auto watching = std::make_unique<event_watch>(event_watch{std::move(observe), thrown_.get()});
        invoke(pc_solver_observe_events, get(), &forward_event, static_cast<void *>(watching.get()));
        event_watch_ = std::move(watching);
    }

    /// The state at t, or where an event or its observer ended the call: ended_by() and time() tell.
    vector advance(double t)
    {
        vector y(dim_);
        invoke(pc_solver_advance, get(), t, y.data(), dim_);
        return y;
    }
    /// The motion up to t, or to where an event or its observer ended it.
    dense run_dense(double t)
    {
        pc_dense *raw = nullptr;
        pc_error *from = nullptr;
        const pc_status status = pc_solver_run_dense(get(), t, &raw, &from);
        dense made(raw);
        settle(status, from);
        return made;
    }
    /// Calls `observe` at each time until it answers false; whether all times were reached.
    bool run(const vector &times, const observer &observe)
    {
        watch watching{observe, {}, thrown_.get()};
        return invoke(pc_solver_run, get(), times.data(), times.size(), &forward, static_cast<void *>(&watching)) ==
               PC_OK;
    }
    double time() const
    {
        double t = 0.0;
        detail::call(pc_solver_time, static_cast<const pc_solver *>(get()), &t);
        return t;
    }
    vector state() const
    {
        vector y(dim_);
        detail::call(pc_solver_state, static_cast<const pc_solver *>(get()), y.data(), dim_);
        return y;
    }
    /// A derivative of y, or y itself, inside the last step.
    vector interpolate(double t, unsigned derivative = 0)
    {
        vector y(dim_);
        detail::call(pc_solver_interpolate, get(), t, derivative, y.data(), dim_);
        return y;
    }
    pc_statistics statistics() const
    {
        pc_statistics work{};
        detail::call(pc_solver_statistics, static_cast<const pc_solver *>(get()), &work, sizeof work);
        return work;
    }
    /// Time and state as bytes, for restore().
    std::vector<unsigned char> checkpoint(const std::string &label = "")
    {
        void *raw = nullptr;
        std::size_t length = 0;
        detail::call(pc_solver_checkpoint, get(), label.c_str(), &raw, &length);
        const detail::owned<void, pc_bytes_free> given(raw);
        const auto *bytes = static_cast<const unsigned char *>(raw);
        return std::vector<unsigned char>(bytes, bytes + length);
    }

    std::vector<std::string> event_names() const
    {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < pc_solver_event_count(get()); i++) {
            names.emplace_back(pc_solver_event_name(get(), i));
        }
        return names;
    }
    /// How often an event has occurred.
    std::uint64_t occurrences(std::size_t event) const
    {
        std::uint64_t count = 0;
        detail::call(pc_solver_event_occurrences, static_cast<const pc_solver *>(get()), event, &count);
        return count;
    }
    /// Its last occurrence, if there was one.
    std::optional<occurrence> last_occurrence(std::size_t event) const
    {
        if (occurrences(event) == 0) {
            return std::nullopt;
        }
        occurrence last{event, 0.0, vector(dim_), vector(dim_)};
        detail::call(pc_solver_last_occurrence, static_cast<const pc_solver *>(get()), event, &last.t,
                     last.before.data(), dim_, last.after.data(), dim_);
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
    struct watch {
        const observer &observe;
        vector y;
        std::exception_ptr *thrown;
    };
    struct event_watch {
        event_observer observe;
        std::exception_ptr *thrown;
    };
    struct own_event {
        event_function function;
        event_reset reset;
        std::exception_ptr *thrown;
    };

    /// What `body` answers; 1 if it throws, which is kept.
    template <class Body> static int caught(std::exception_ptr *thrown, Body body) noexcept
    {
        try {
            return body();
        } catch (...) {
            *thrown = std::current_exception();
            return 1;
        }
    }
    static int forward(double t, const double *y, std::size_t length, void *user) noexcept
    {
        auto &watching = *static_cast<watch *>(user);
        return caught(watching.thrown, [&] {
            watching.y.assign(y, y + length);
            return watching.observe(t, watching.y) ? 0 : 1;
        });
    }
    static int forward_event(std::size_t event, double t, const double *before, const double *after,
                             std::size_t length, void *user) noexcept
    {
        auto &watching = *static_cast<event_watch *>(user);
        return caught(watching.thrown, [&] {
            const occurrence now{event, t, vector(before, before + length), vector(after, after + length)};
            return watching.observe(now) ? 0 : 1;
        });
    }
    static int forward_function(double t, const double *y, std::size_t length, double *value, void *user) noexcept
    {
        auto &event = *static_cast<own_event *>(user);
        return caught(event.thrown, [&] {
            *value = event.function(t, vector(y, y + length));
            return 0;
        });
    }
    static int forward_reset(double t, double *y, std::size_t length, void *user) noexcept
    {
        auto &event = *static_cast<own_event *>(user);
        return caught(event.thrown, [&] {
            vector state(y, y + length);
            event.reset(t, state);
            for (std::size_t i = 0; i < length; i++) {
                y[i] = state.at(i);
            }
            return 0;
        });
    }
    static void destroy_event(void *user) noexcept { delete static_cast<own_event *>(user); }

    /// Throws what a function or observer has thrown, or the error of the call.
    void settle(pc_status status, pc_error *raw)
    {
        detail::owned<pc_error, pc_error_free> from(raw);
        // What a function threw where the integration then did without its value is no failure.
        if (status == PC_OK) {
            *thrown_ = nullptr;
        }
        if (*thrown_) {
            std::rethrow_exception(std::exchange(*thrown_, nullptr));
        }
        detail::check(status, from.release());
    }
    /// Calls a function that may call back.
    template <class Function, class... Arguments> pc_status invoke(Function function, Arguments... arguments)
    {
        pc_error *from = nullptr;
        const pc_status status = function(arguments..., &from);
        settle(status, from);
        return status;
    }

    solver(const system &of, double t, const double *y, std::size_t length, const pc_solver_options &options)
        : dim_(of.dim())
    {
        pc_solver *raw = nullptr;
        detail::call(pc_solver_new, static_cast<const pc_system *>(of.get()), &options, t, y, length, &raw);
        handle_.reset(raw);
    }
    solver(pc_solver *raw, std::size_t dim) : handle_(raw), dim_(dim) {}

    // Where functions put what they throw: it stays in its place when the solver moves, and outlives the handle.
    std::unique_ptr<std::exception_ptr> thrown_ = std::make_unique<std::exception_ptr>();
    std::unique_ptr<event_watch> event_watch_;
    detail::owned<pc_solver, pc_solver_free> handle_;
    std::size_t dim_;
};

/// What has come of a member of an ensemble.
struct member {
    std::size_t number;
    /// PC_OK, PC_EVENT, or why it failed, of which the message tells.
    pc_status status;
    std::string message;
    /// The output times that it reached, and the state at each.
    vector times;
    std::vector<vector> states;
};

/// Integrates many members through the times: from `states` at t, or from the start of the model if there are none, and
/// with `parameters`, or those of the system if there are none. Calls `observe` for each in order until it answers
/// false; whether it never did. What it throws comes out here. `threads` is 0 for one on each core.
inline bool run_ensemble(const system &of, double t, const std::vector<vector> &states,
                         const std::vector<vector> &parameters, const vector &times,
                         const std::function<bool(const member &)> &observe, std::size_t threads = 0,
                         const pc_solver_options &options = solver::default_options())
{
    struct watch {
        const std::function<bool(const member &)> &observe;
        std::exception_ptr thrown;
    };
    struct local {
        static int forward(const pc_member *of, void *user) noexcept
        {
            auto &watching = *static_cast<watch *>(user);
            try {
                member told{of->number, of->status, of->message ? of->message : "", {}, {}};
                told.times.assign(of->times, of->times + of->rows);
                for (std::size_t i = 0; i < of->rows; i++) {
                    told.states.emplace_back(of->states + i * of->dim, of->states + (i + 1) * of->dim);
                }
                return watching.observe(told) ? 0 : 1;
            } catch (...) {
                watching.thrown = std::current_exception();
                return 1;
            }
        }
        static vector flat(const std::vector<vector> &rows, std::size_t width, const char *what)
        {
            vector all;
            for (const vector &row : rows) {
                detail::sized(row, width, what);
                all.insert(all.end(), row.begin(), row.end());
            }
            return all;
        }
    };
    const vector starts = local::flat(states, of.dim(), "a state");
    const vector values = local::flat(parameters, pc_system_parameter_count(of.get()), "a set of parameters");
    watch watching{observe, nullptr};
    const pc_status status = detail::call(
        pc_ensemble_run, static_cast<const pc_system *>(of.get()), &options,
        states.empty() ? parameters.size() : states.size(), t, states.empty() ? nullptr : starts.data(),
        starts.size(), parameters.empty() ? nullptr : values.data(), values.size(), times.data(), times.size(),
        threads, &local::forward, static_cast<void *>(&watching));
    if (watching.thrown) {
        std::rethrow_exception(watching.thrown);
    }
    return status == PC_OK;
}

/// The right-hand side for one thread, for an integrator of one's own.
class kernel {
public:
    explicit kernel(const system &of)
    {
        pc_kernel *raw = nullptr;
        detail::call(pc_kernel_new, static_cast<const pc_system *>(of.get()), &raw);
        handle_.reset(raw);
    }
    /// Not 0 where it cannot be evaluated; both arrays have dim() numbers.
    int operator()(double t, const double *y, double *ydot) { return pc_kernel_rhs(t, y, ydot, handle_.get()); }
    std::size_t dim() const noexcept { return pc_kernel_dim(handle_.get()); }

private:
    detail::owned<pc_kernel, pc_kernel_free> handle_;
};

} // namespace pc

#endif // PC_HPP
