/*
 * pc: the Poincaré–Chetaev equations of a mechanical system, derived, compiled and integrated.
 *
 *     pc_model *model = NULL;
 *     pc_system *top = NULL;
 *     pc_error *error = NULL;
 *     if (pc_model_builtin("heavy-top-lagrange", &model, &error) == PC_OK &&
 *         pc_system_new(model, NULL, &top, &error) == PC_OK) {
 *         ... pc_system_rhs(top, t, y, n, ydot, n, &error) ...
 *     }
 *     if (error) fprintf(stderr, "%s\n", pc_error_message(error));
 *     pc_error_free(error);
 *     pc_system_free(top);
 *     pc_model_free(model);
 *
 * State. y has n coordinates x, then quasi-velocities (or momenta, in the canonical form), then
 * first-order states; ydot is its rate.
 *
 * Errors. A function that can fail returns a pc_status, and takes as last argument a place for a
 * pc_error, or NULL. There it writes NULL if all went well, and otherwise a new error, which you
 * free; what stood there before is not looked at. PC_STOPPED and PC_EVENT are no failures: an
 * observer, or a terminal event, has ended an integration. Results are written unless the call
 * fails, except that a new handle or text is NULL after a failure, and that arrays for results may
 * hold anything then.
 *
 * Ownership. What a function of the name ..._new, ..._clone, pc_model_parse, pc_model_from_file,
 * pc_model_builtin, pc_solver_restore or pc_solver_run_dense gives, you free with the ..._free of
 * its type; `char *` you free with pc_string_free, bytes with pc_bytes_free; `const char *`
 * belongs to the handle it came from and lives as long, or is static. All ..._free allow NULL.
 * Handles are independent: a model can be freed while its system lives, and a system while its
 * solvers and kernels do.
 *
 * Arrays. Each comes with its length, which has to be the right one, not only large enough. They
 * are `double`, aligned as such, and an array that is written shares no memory with another one;
 * this is checked. NULL goes with the length 0. Matrices are dense and column-major,
 * A[i + j*rows], unless the function says otherwise. Text is UTF-8 and zero-terminated.
 *
 * Threads. Nothing is global. A handle may go from thread to thread and is used by one call at a
 * time: a second one at the same time returns PC_BUSY and does nothing; only of pc_system_rhs many
 * may succeed side by side, as it says. (Freeing a handle while another thread uses it is not
 * safe, as ever.) Different handles are independent; to evaluate on many threads, give each its
 * own by pc_system_clone, or a pc_kernel, which is the one handle that does not notice a second
 * call. Names and sizes may be read at any time, by any number of threads, and a pc_cancel used.
 * That a function takes a handle as `const` says that what it computes stays, no more.
 *
 * Not for signal handlers, but for pc_cancel_request. A fault of the library is PC_INTERNAL and
 * does not end your program; memory that is exhausted does, and a stack: a thread needs 128 KiB,
 * whatever the model; what goes deeper takes a stack of its own, of 8 MiB, while it derives.
 */

#ifndef PC_H
#define PC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * First number of the version of the header.
 */
#define PC_VERSION_MAJOR 0

/**
 * Second number of the version of the header.
 */
#define PC_VERSION_MINOR 1

/**
 * Third number of the version of the header.
 */
#define PC_VERSION_PATCH 0

/**
 * Version of the binary interface, the number in the name libpc.so.N. A program runs with
 * any library of the same number that is not older than its header.
 */
#define PC_ABI_VERSION 0

/**
 * How a call ended. New ones may be added, so treat an unknown one as an error; PC_STATUS_LAST,
 * which is never returned, makes room for them.
 */
typedef enum {
  /**
   * All went well.
   */
  PC_OK = 0,
  /**
   * The call is wrong: a null pointer, a wrong length, a name that is not UTF-8, a number that
   * is not finite, an unknown choice.
   */
  PC_INVALID_ARGUMENT = 1,
  /**
   * The text of the model is wrong, or not UTF-8; the error has the place.
   */
  PC_INVALID_MODEL = 2,
  /**
   * The model contradicts itself; the error has the place.
   */
  PC_INCONSISTENT_MODEL = 3,
  /**
   * What is asked for cannot be done, or not of this system.
   */
  PC_UNSUPPORTED = 4,
  /**
   * There is nothing of this name, such as a file.
   */
  PC_NOT_FOUND = 5,
  /**
   * A file that there is could not be read.
   */
  PC_IO = 6,
  /**
   * The equations cannot be evaluated at this time and state.
   */
  PC_EVALUATION = 7,
  /**
   * The integration could not begin or go on. Events that occur ever more closely, as a ball's
   * that comes to rest, are such an end.
   */
  PC_INTEGRATION = 8,
  /**
   * An observer stopped the integration. This is no failure, and there is no pc_error.
   */
  PC_STOPPED = 9,
  /**
   * The handle is in use: by another thread, or by the call that called the observer or the
   * force function.
   */
  PC_BUSY = 10,
  /**
   * A fault of the library, after which the handle can only be freed; or threads or memory for
   * a solver are not to be had, and the handle is as it was.
   */
  PC_INTERNAL = 11,
  /**
   * A terminal event ended the integration. This is no failure, and there is no pc_error.
   */
  PC_EVENT = 12,
  /**
   * The bytes are no checkpoint, or one of which a part is missing or changed.
   */
  PC_INVALID_CHECKPOINT = 13,
  /**
   * Two derivations of one model give different motions: a defect of the library.
   */
  PC_DISAGREEMENT = 14,
  /**
   * The equations of the model, or an integration, would take more memory or time than they
   * may, or somebody cancelled the work.
   */
  PC_LIMIT = 15,
  /**
   * None.
   */
  PC_STATUS_LAST = 2147483647,
} pc_status;

/**
 * Which equations of motion; values of pc_system_options.form.
 */
typedef enum {
  /**
   * Poincaré's, of quasi-velocities: independent ones if constraints say that the others
   * vanish, all of them with multipliers otherwise.
   */
  PC_POINCARE = 0,
  /**
   * Chetaev's canonical equations, of momenta.
   */
  PC_CANONICAL = 1,
  /**
   * Poincaré's without the coordinates that nothing depends on, Euler–Poincaré's where none is
   * left; the state has fewer coordinates. Where multipliers hold constraints,
   * PC_INCONSISTENT_MODEL, as with all that follow, unless pc_model_add_independent says which
   * velocities are independent.
   */
  PC_REDUCED = 2,
  /**
   * The same in momenta: Lie–Poisson equations.
   */
  PC_LIE_POISSON = 3,
  /**
   * Poincaré's of quasi-velocities that are orthonormal in the kinetic metric.
   */
  PC_ORTHONORMAL = 4,
  /**
   * Hamel's, of the quasi-velocities that pc_model_give_quasi_velocity gives.
   */
  PC_HAMEL = 5,
} pc_form;

/**
 * The method of integration; values of pc_solver_options.method.
 */
typedef enum {
  /**
   * Adams–Moulton formulas of orders 1 to 12, for systems that are not stiff.
   */
  PC_ADAMS = 0,
  /**
   * Backward differentiation formulas of orders 1 to 5, for stiff systems.
   */
  PC_BDF = 1,
} pc_method;

/**
 * How the equation of a step is solved; values of pc_solver_options.iteration.
 */
typedef enum {
  /**
   * Newton's for PC_BDF, the fixed-point iteration for PC_ADAMS.
   */
  PC_ITERATION_OF_METHOD = 0,
  /**
   * Newton's iteration, with a linear solver.
   */
  PC_NEWTON = 1,
  /**
   * The fixed-point iteration, which needs no Jacobian.
   */
  PC_FIXED_POINT = 2,
} pc_iteration;

/**
 * How the linear systems of Newton's iteration are solved; values of
 * pc_solver_options.linear_solver.
 */
typedef enum {
  /**
   * Chosen by the size and the zero pattern of the Jacobian.
   */
  PC_LINEAR_AUTOMATIC = 0,
  /**
   * Dense LU factors.
   */
  PC_LINEAR_DENSE = 1,
  /**
   * Sparse LU factors.
   */
  PC_LINEAR_SPARSE = 2,
  /**
   * GMRES without a matrix.
   */
  PC_LINEAR_KRYLOV = 3,
} pc_linear_solver;

/**
 * How equations are printed.
 */
typedef enum {
  /**
   * As a book prints them, in UTF-8.
   */
  PC_TEXT = 0,
  /**
   * Displays of LaTeX with amsmath.
   */
  PC_LATEX = 1,
  /**
   * One JSON object, for programs.
   */
  PC_JSON = 2,
} pc_format;

/**
 * In which direction the function of an event passes through zero, as the integration goes.
 */
typedef enum {
  /**
   * From above.
   */
  PC_FALLING = -1,
  /**
   * Either way.
   */
  PC_BOTH = 0,
  /**
   * From below.
   */
  PC_RISING = 1,
} pc_direction;

/**
 * Ends derivations of systems that were given it in pc_system_options, and integrations of these.
 * Any number of threads may use it at the same time. Free it with pc_cancel_free.
 */
typedef struct pc_cancel pc_cancel;

/**
 * A motion as a function of time. It never changes, so that any number of threads may use it.
 * Free it with pc_dense_free.
 */
typedef struct pc_dense pc_dense;

/**
 * Why a call failed: status, message and, for a model, the place in its text. Never changes;
 * free it with pc_error_free.
 */
typedef struct pc_error pc_error;

/**
 * f(t, y) for an integrator of one's own: the context of pc_kernel_rhs and pc_kernel_jacobian.
 * Free it with pc_kernel_free.
 *
 * It has room to compute in, so each thread needs its own, and two calls at the same time are
 * not safe; in return there are no locks.
 */
typedef struct pc_kernel pc_kernel;

/**
 * A model: parameters, frame, energy, forces, constraints, start. Free it with pc_model_free.
 */
typedef struct pc_model pc_model;

/**
 * An integration, which stands at a time with a state. Free it with pc_solver_free.
 */
typedef struct pc_solver pc_solver;

/**
 * The equations of motion of a model, compiled: ẏ = f(t, y). Free it with pc_system_free.
 */
typedef struct pc_system pc_system;

/**
 * What to derive. Set it up with pc_system_options_init.
 */
typedef struct {
  /**
   * sizeof(pc_system_options), set by pc_system_options_init.
   */
  size_t size;
  /**
   * A pc_form; PC_POINCARE by default.
   */
  int form;
  /**
   * 0: room for a choice to come.
   */
  int reserved;
  /**
   * Most bytes that the expressions of a derivation may take, as they are estimated; 0, the
   * default, for 4 GiB. Beyond it, PC_LIMIT. It holds for pc_system_new, and for each later
   * call that derives by itself, as do the next two.
   */
  uint64_t memory_limit;
  /**
   * Most seconds that a derivation may take, and each call of a solver or an ensemble of the
   * system, positive; 0, the default, for no limit.
   */
  double time_limit;
  /**
   * By which derivations and integrations are ended; NULL, the default, for none. It may be
   * freed when pc_system_new has returned.
   */
  const pc_cancel *cancel;
} pc_system_options;

/**
 * How to integrate. Set it up with pc_solver_options_init, then change what you like.
 */
typedef struct {
  /**
   * sizeof(pc_solver_options), set by pc_solver_options_init.
   */
  size_t size;
  /**
   * A pc_method; PC_ADAMS by default.
   */
  int method;
  /**
   * A pc_iteration; PC_ITERATION_OF_METHOD by default.
   */
  int iteration;
  /**
   * A pc_linear_solver; PC_LINEAR_AUTOMATIC by default. Only for Newton's iteration.
   */
  int linear_solver;
  /**
   * Highest order of the method; 0, the default, for all it has.
   */
  int max_order;
  /**
   * Relative tolerance, positive; 1e-9 by default.
   */
  double relative_tolerance;
  /**
   * Absolute tolerance of all components, positive; 1e-12 by default.
   */
  double absolute_tolerance;
  /**
   * Absolute tolerances, one for each component, copied; NULL, the default, for the one above.
   */
  const double *absolute_tolerances;
  /**
   * Their number, 0 without.
   */
  size_t absolute_tolerances_length;
  /**
   * Most steps from one output to the next; 500000 by default.
   */
  uint64_t max_steps;
  /**
   * Length of the first step, positive in both directions of time; 0, the default, for an
   * estimate.
   */
  double initial_step;
  /**
   * Least length of a step; 0, the default, for none.
   */
  double min_step;
  /**
   * Largest length of a step; 0, the default, for none.
   */
  double max_step;
  /**
   * A time beyond which the equations are never evaluated; infinite, the default, for none.
   */
  double stop_time;
  /**
   * Events are looked for at the ends of so many equal parts of each step, at least 1; 4 by
   * default. Between two such places an even number of zeros may be missed.
   */
  uint32_t samples_per_step;
  /**
   * 0: room for a choice to come.
   */
  uint32_t reserved;
  /**
   * Events that follow each other ever faster are an error once what is left of the first of
   * their distances is this part, from 0, for never, to less than 1; 1e-5 by default.
   */
  double accumulation;
} pc_solver_options;

/**
 * Writes the external forces at (t, y) to q: one for each that was declared, in that order, so
 * `q_length` is pc_system_force_count. y is the state of the system; in the canonical form it
 * has momenta. Returns 0; a positive number where the forces are not defined, so that a smaller
 * step may help; a negative one to give up. What is left unwritten is not a number, and treated
 * as a positive answer. It must return: no exceptions, no longjmp.
 */
typedef int (*pc_force_function)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *q,
                                 size_t q_length,
                                 void *user);

/**
 * Writes the derivatives of the external forces at (t, y), all of them, column-major: ∂q_i/∂y_j
 * to `dq[i + j*e]` for e forces, so `dq_length` is e * `y_length`. Otherwise as
 * pc_force_function.
 */
typedef int (*pc_force_jacobian)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *dq,
                                 size_t dq_length,
                                 void *user);

/**
 * Frees what the `user` of a function points to. It must return: no exceptions, no longjmp.
 */
typedef void (*pc_destroy)(void *user);

/**
 * Is given the state at each output time. Returns 0 to go on; anything else ends the run with
 * PC_STOPPED. It may call any function on other handles, and must return: no exceptions, no
 * longjmp.
 */
typedef int (*pc_observer)(double t, const double *y, size_t y_length, void *user);

/**
 * Is given each event where it occurs, by its number among the events of the solver, with the
 * states before and after it, which are valid during the call. Of simultaneous events each has
 * the state that it found and the one that it left. Returns 0 to go on; anything else ends the
 * call with PC_STOPPED, or with PC_EVENT where a terminal event does so too. Otherwise as
 * pc_observer.
 */
typedef int (*pc_event_observer)(size_t event,
                                 double t,
                                 const double *before,
                                 const double *after,
                                 size_t y_length,
                                 void *user);

/**
 * Writes g(t, y), which passes through zero where the event occurs. Returns 0; anything else
 * ends the integration with PC_INTEGRATION, as a value does that is not finite or not written.
 * It should depend on nothing but its arguments and be smooth. It must return: no exceptions, no
 * longjmp.
 */
typedef int (*pc_event_function)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *value,
                                 void *user);

/**
 * Turns the state y before the event into the state after it. Otherwise as pc_event_function.
 */
typedef int (*pc_event_reset)(double t, double *y, size_t y_length, void *user);

/**
 * Counts since the start of an integration, and its last internal step. It may grow at the end.
 */
typedef struct {
  /**
   * Internal steps.
   */
  uint64_t steps;
  /**
   * Evaluations of f, with those for difference quotients.
   */
  uint64_t rhs_evaluations;
  /**
   * Evaluations of ∂f/∂y.
   */
  uint64_t jacobian_evaluations;
  /**
   * Steps tried again because the estimated error was too large.
   */
  uint64_t error_test_failures;
  /**
   * Iterations of the nonlinear solver.
   */
  uint64_t nonlinear_iterations;
  /**
   * Failures of the nonlinear solver.
   */
  uint64_t nonlinear_failures;
  /**
   * Factorisations, or renewals of the preconditioner.
   */
  uint64_t linear_setups;
  /**
   * Iterations of the Krylov solver.
   */
  uint64_t linear_iterations;
  /**
   * Order of the last step, 0 before the first.
   */
  uint64_t last_order;
  /**
   * Length of the last step, with the sign of the direction; 0 before the first.
   */
  double last_step;
  /**
   * Length that the next step will be tried with.
   */
  double next_step;
  /**
   * End of the last step, which may lie beyond the time of the solver.
   */
  double step_time;
  /**
   * Steps that were to end no later than where the explicit dependence on time shows something
   * that the motion up to there does not let expect: the beginning of a pulse, a jump.
   */
  uint64_t limited_steps;
} pc_statistics;

/**
 * What has come of a member of an ensemble. It may grow at the end.
 */
typedef struct {
  /**
   * Its number, from 0.
   */
  size_t number;
  /**
   * PC_OK; PC_EVENT if a terminal event ended it; else why it failed.
   */
  pc_status status;
  /**
   * Why it failed, else NULL.
   */
  const char *message;
  /**
   * The output times that it reached, as many as `rows`; the time of a terminal event is the
   * last one.
   */
  const double *times;
  /**
   * The states at these, one after the other, each of `dim` numbers. As `times`, NULL where
   * there are none.
   */
  const double *states;
  /**
   * How many these are, also if it failed.
   */
  size_t rows;
  /**
   * The length of a state.
   */
  size_t dim;
} pc_member;

/**
 * Is given each member in order, on the thread of the call; what it points to is valid during
 * the call. Returns 0 to go on; anything else ends the ensemble with PC_STOPPED. Otherwise as
 * pc_observer.
 */
typedef int (*pc_member_observer)(const pc_member *member, void *user);

/**
 * The version of the library, such as "0.1.0". Static.
 */
const char *pc_version(void);

/**
 * The PC_ABI_VERSION of the library that runs.
 */
uint32_t pc_abi_version(void);

/**
 * The name of a status, such as "PC_OK"; "unknown status" of a number that is none. Static.
 */
const char *pc_status_name(int status);

/**
 * Its status, never PC_OK; PC_OK of null.
 */
pc_status pc_error_status(const pc_error *error);

/**
 * The message, in UTF-8, never null; it lives as long as the error. For a model it shows the
 * line at fault and what would be right, over several lines of text. The empty text of null.
 */
const char *pc_error_message(const pc_error *error);

/**
 * The line of the model text at fault, from 1; 0 if there is none, or of null.
 */
size_t pc_error_line(const pc_error *error);

/**
 * The column at which the text at fault begins, in characters from 1; 0 if there is none, or of
 * null.
 */
size_t pc_error_column(const pc_error *error);

/**
 * The byte at which the text at fault begins, from 0; 0 if there is none, or of null.
 */
size_t pc_error_offset(const pc_error *error);

/**
 * The number of bytes of the text at fault; 0 if there is none, or of null.
 */
size_t pc_error_length(const pc_error *error);

/**
 * The code that CVODES returned (cvodes.h), where it is the reason; else 0, as of null.
 */
int pc_error_integrator_code(const pc_error *error);

/**
 * 1 if the status is PC_EVALUATION and another state near by may do, so that an integrator
 * should try a smaller step; else 0, as of null.
 */
int pc_error_is_recoverable(const pc_error *error);

/**
 * Frees an error. Null is allowed.
 */
void pc_error_free(pc_error *error);

/**
 * Frees a text that a function of this library has returned to be freed. Null is allowed.
 */
void pc_string_free(char *text);

/**
 * Reads a model from `length` bytes of text, which need no zero at the end. `name` is how
 * messages call it; NULL for "model".
 */
pc_status pc_model_parse(const char *text,
                         size_t length,
                         const char *name,
                         pc_model **model,
                         pc_error **error);

/**
 * Reads a model from a file.
 */
pc_status pc_model_from_file(const char *path, pc_model **model, pc_error **error);

/**
 * A model that comes with the library, such as "heavy-top-lagrange".
 */
pc_status pc_model_builtin(const char *name, pc_model **model, pc_error **error);

/**
 * The number of models that come with the library.
 */
size_t pc_builtin_count(void);

/**
 * The name of such a model, from 0; NULL beyond the last. Static.
 */
const char *pc_builtin_name(size_t index);

/**
 * A copy that can be changed by itself.
 */
pc_status pc_model_clone(const pc_model *model, pc_model **copy, pc_error **error);

/**
 * Frees a model. Null is allowed.
 */
void pc_model_free(pc_model *model);

/**
 * Sets a parameter of the model to another value.
 */
pc_status pc_model_set(pc_model *model, const char *name, double value, pc_error **error);

/**
 * Has states projected to the value that this integral, or "energy", has at the start: after
 * each step of a solver, and by pc_system_project. An unknown name is found by pc_system_new.
 */
pc_status pc_model_keep(pc_model *model, const char *integral, pc_error **error);

/**
 * Whether the start is moved to where the constraints are satisfied (else a start off them is
 * refused). Not 0 is yes.
 */
pc_status pc_model_project_start(pc_model *model, int yes, pc_error **error);

/**
 * Has a start that is moved to where the constraints are satisfied keep the value of this
 * coordinate or quasi-velocity: the others follow. Without pc_model_project_start it says
 * nothing. An unknown name is found by pc_system_new, with PC_NOT_FOUND.
 */
pc_status pc_model_hold_start(pc_model *model, const char *name, pc_error **error);

/**
 * Whether the reactions of the constraints are observed, each called `λ_` and the name of its
 * constraint. Not 0 is yes.
 */
pc_status pc_model_observe_reactions(pc_model *model, int yes, pc_error **error);

/**
 * Whether systems of the model are derived with their derivatives by parameters, which
 * pc_solver_add_sensitivity takes. Not 0 is yes.
 */
pc_status pc_model_differentiate(pc_model *model, int yes, pc_error **error);

/**
 * The text of the model, to be freed with pc_string_free. That of a model built by calls is the
 * text that these wrote; lines and columns of errors are counted in it. What no text says is not
 * in it: pc_model_set of parameters, pc_model_set_start of a model that was read, pc_model_keep,
 * pc_model_project_start, pc_model_hold_start, pc_model_observe_reactions,
 * pc_model_differentiate, pc_model_add_external_force, pc_model_give_quasi_velocity,
 * pc_model_add_independent.
 */
pc_status pc_model_text(const pc_model *model, char **text, pc_error **error);

/**
 * A model without anything, to be built by the calls below, in any order between sorts of
 * entries; the order of coordinates, quasi-velocities, parameters and so on is that of their
 * calls. Expressions are those of the text model, where `x'` is the velocity of the coordinate
 * x, and `t` the time. What is said is understood as a whole by pc_model_check and
 * pc_system_new, whose errors name the entry and show its expression.
 */
pc_status pc_model_new(const char *name, pc_model **model, pc_error **error);

/**
 * Reads what has been said as a whole: PC_OK if all names are known and all expressions well
 * formed, and the frame and the start are in order. Whether equations can be derived is found by
 * pc_system_new.
 */
pc_status pc_model_check(const pc_model *model, pc_error **error);

/**
 * Adds a parameter with its value, which pc_model_set and pc_system_set_parameter change.
 */
pc_status pc_model_add_parameter(pc_model *model,
                                 const char *name,
                                 double value,
                                 pc_error **error);

/**
 * Adds a parameter that is an expression in those before it, which it follows until it is set
 * itself.
 */
pc_status pc_model_add_parameter_expression(pc_model *model,
                                            const char *name,
                                            const char *expression,
                                            pc_error **error);

/**
 * Adds an input: a value that is constant until it is set, as parameters are, after all of which
 * it comes. Forces, rates of states, events and what is watched may contain it, but nothing that
 * velocities or momenta depend on.
 */
pc_status pc_model_add_input(pc_model *model, const char *name, double value, pc_error **error);

/**
 * Adds an input that is a function of time: `length` values at rising times, between them
 * "linear", "cubic" or "hold"; NULL for "linear". No step of a solver crosses one of the times.
 * Its values are not set otherwise.
 */
pc_status pc_model_add_input_table(pc_model *model,
                                   const char *name,
                                   const double *times,
                                   const double *values,
                                   size_t length,
                                   const char *interpolation,
                                   pc_error **error);

/**
 * Adds an input whose table is a column of a file of numbers with commas between them, below a
 * line of names; otherwise as pc_model_add_input_table. `time` is the name of the column of
 * times, NULL for "t" or else the first. The path is taken from the working directory as it is
 * now.
 */
pc_status pc_model_add_input_file(pc_model *model,
                                  const char *name,
                                  const char *path,
                                  const char *column,
                                  const char *time,
                                  const char *interpolation,
                                  pc_error **error);

/**
 * Adds a first-order state with its value at the start and its rate: an expression of time,
 * coordinates, velocities and states. It is integrated with the motion and comes after the
 * velocities in the state; no frame knows it.
 */
pc_status pc_model_add_state(pc_model *model,
                             const char *name,
                             const char *rate,
                             double start,
                             pc_error **error);

/**
 * Sets the acceleration of gravity, along the axes of the positions of bodies, as expressions of
 * parameters and t: it acts on the mass centres of all bodies and counts in the energy.
 */
pc_status pc_model_set_gravity(pc_model *model,
                               const char *x,
                               const char *y,
                               const char *z,
                               pc_error **error);

/**
 * Adds a name for an expression.
 */
pc_status pc_model_add_definition(pc_model *model,
                                  const char *name,
                                  const char *expression,
                                  pc_error **error);

/**
 * Adds a coordinate with its value at the start.
 */
pc_status pc_model_add_coordinate(pc_model *model,
                                  const char *name,
                                  double start,
                                  pc_error **error);

/**
 * Adds a quasi-velocity with its value at the start. Its `definition` is an expression affine in
 * the velocities x', or NULL where the kinematics are given the other way round, by
 * pc_model_set_kinematics. Without any quasi-velocities they are the velocities themselves;
 * `name` may then be `x'`, to give one its value at the start.
 */
pc_status pc_model_add_quasi_velocity(pc_model *model,
                                      const char *name,
                                      const char *definition,
                                      double start,
                                      pc_error **error);

/**
 * Sets the velocity of a coordinate as an expression affine in the quasi-velocities, (3): for
 * every coordinate, or for none.
 */
pc_status pc_model_set_kinematics(pc_model *model,
                                  const char *coordinate,
                                  const char *velocity,
                                  pc_error **error);

/**
 * Sets the brackets of the frame to those of an algebra by its name, such as "so3"; needed only
 * where the frame does not determine them.
 */
pc_status pc_model_set_algebra(pc_model *model, const char *name, pc_error **error);

/**
 * Sets the bracket [X_left, X_right], (5), as a linear combination of quasi-velocities, such as
 * "w3"; brackets that are not set are zero. `left` may be "t", for X_0. Instead of
 * pc_model_set_algebra.
 */
pc_status pc_model_set_bracket(pc_model *model,
                               const char *left,
                               const char *right,
                               const char *value,
                               pc_error **error);

/**
 * Adds a constraint: the expression, of coordinates or of velocities, vanishes. One that is not
 * affine in the velocities is said to be so by pc_model_set_constraint_kind.
 */
pc_status pc_model_add_constraint(pc_model *model,
                                  const char *name,
                                  const char *expression,
                                  pc_error **error);

/**
 * Sets the Lagrangian L(t, x, η), in which x' may stand too. Excludes kinetic and potential
 * energy.
 */
pc_status pc_model_set_lagrangian(pc_model *model, const char *expression, pc_error **error);

/**
 * Sets the kinetic energy.
 */
pc_status pc_model_set_kinetic(pc_model *model, const char *expression, pc_error **error);

/**
 * Sets the potential energy.
 */
pc_status pc_model_set_potential(pc_model *model, const char *expression, pc_error **error);

/**
 * Sets a dissipation function R, which gives the forces Q_s = −∂R/∂η_s.
 */
pc_status pc_model_set_dissipation(pc_model *model, const char *expression, pc_error **error);

/**
 * Adds a force, conjugate to a quasi-velocity, or to a coordinate.
 */
pc_status pc_model_add_force(pc_model *model,
                             const char *on,
                             const char *expression,
                             pc_error **error);

/**
 * Adds an expression that should stay constant, to be watched.
 */
pc_status pc_model_add_integral(pc_model *model,
                                const char *name,
                                const char *expression,
                                pc_error **error);

/**
 * Adds an expression to be watched.
 */
pc_status pc_model_add_output(pc_model *model,
                              const char *name,
                              const char *expression,
                              pc_error **error);

/**
 * Adds a particle, or a rigid body if it is given an inertia: its mass, and the position of its
 * mass centre or of a point of it that is at rest, as expressions of coordinates. Energy and
 * forces follow from bodies; no Lagrangian is needed beside them.
 */
pc_status pc_model_add_body(pc_model *model,
                            const char *name,
                            const char *mass,
                            const char *x,
                            const char *y,
                            const char *z,
                            pc_error **error);

/**
 * Sets the force on a body, which acts at its position, in axes of space.
 */
pc_status pc_model_set_body_force(pc_model *model,
                                  const char *body,
                                  const char *x,
                                  const char *y,
                                  const char *z,
                                  pc_error **error);

/**
 * Sets the torque on a rigid body, in the axes of its angular velocity.
 */
pc_status pc_model_set_body_torque(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the angular velocity of a rigid body, in axes of the body. Excludes
 * pc_model_set_body_rotation.
 */
pc_status pc_model_set_body_angular_velocity(pc_model *model,
                                             const char *body,
                                             const char *x,
                                             const char *y,
                                             const char *z,
                                             pc_error **error);

/**
 * Sets the inertia of a rigid body about its position, in axes of the body: 3 expressions Ixx,
 * Iyy, Izz, or 6, which go on with Ixy, Iyz, Ixz.
 */
pc_status pc_model_set_body_inertia(pc_model *model,
                                    const char *body,
                                    const char *const *entries,
                                    size_t length,
                                    pc_error **error);

/**
 * Sets how a rigid body is turned: the 9 entries of the matrix R from axes of the body to those
 * of space, row by row.
 */
pc_status pc_model_set_body_rotation(pc_model *model,
                                     const char *body,
                                     const char *const *entries,
                                     size_t length,
                                     pc_error **error);

/**
 * Adds a body that hangs on another, or on the world if `parent` is null, by a joint of this
 * kind: fixed, revolute, prismatic, screw, cylindrical, universal, planar, spherical, free. Its
 * origin is the point of the joint. Inertia, force and torque are set as those of other bodies,
 * start values by pc_model_add_coordinate and pc_model_add_quasi_velocity with the names that
 * the joint gives: `NAME` and `NAME'` of a revolute one.
 */
pc_status pc_model_add_jointed_body(pc_model *model,
                                    const char *name,
                                    const char *parent,
                                    const char *kind,
                                    pc_error **error);

/**
 * Sets the mass of a body that hangs by a joint.
 */
pc_status pc_model_set_body_mass(pc_model *model,
                                 const char *body,
                                 const char *mass,
                                 pc_error **error);

/**
 * Sets the mass centre of a body that hangs by a joint, in axes of the body from its origin.
 */
pc_status pc_model_set_body_center(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the point of a joint, in axes of the parent from its origin.
 */
pc_status pc_model_set_joint_place(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the axis of a joint, in axes of the joint; `axis` has 3 numbers, of any length but 0.
 */
pc_status pc_model_set_joint_axis(pc_model *model,
                                  const char *body,
                                  const double *axis,
                                  pc_error **error);

/**
 * Sets the two axes of a universal joint, of 3 numbers each: the first stands still in the
 * parent, the second in the body.
 */
pc_status pc_model_set_joint_axes(pc_model *model,
                                  const char *body,
                                  const double *first,
                                  const double *second,
                                  pc_error **error);

/**
 * Sets the advance of a screw, a length a radian.
 */
pc_status pc_model_set_joint_pitch(pc_model *model,
                                   const char *body,
                                   const char *pitch,
                                   pc_error **error);

/**
 * Sets how the axes of a joint stand in those of the parent: the 9 entries of the matrix from
 * the former to the latter, row by row. Excludes pc_model_set_joint_turns.
 */
pc_status pc_model_set_joint_rotation(pc_model *model,
                                      const char *body,
                                      const char *const *entries,
                                      size_t length,
                                      pc_error **error);

/**
 * Sets the same by turns about axes: `axes` has a letter x, y or z for each of the `length`
 * angles, every turn being about an axis as turned by those before it.
 */
pc_status pc_model_set_joint_turns(pc_model *model,
                                   const char *body,
                                   const char *axes,
                                   const char *const *angles,
                                   size_t length,
                                   pc_error **error);

/**
 * Gives the coordinates of a joint other names than those of its kind.
 */
pc_status pc_model_name_joint_coordinates(pc_model *model,
                                          const char *body,
                                          const char *const *names,
                                          size_t length,
                                          pc_error **error);

/**
 * Gives the quasi-velocities of a joint other names than those of its kind.
 */
pc_status pc_model_name_joint_quasi_velocities(pc_model *model,
                                               const char *body,
                                               const char *const *names,
                                               size_t length,
                                               pc_error **error);

/**
 * Adds a point of a body that hangs by a joint, in axes of the body from its origin. Expressions
 * know its place as `NAME_x`, `NAME_y`, `NAME_z`.
 */
pc_status pc_model_add_point(pc_model *model,
                             const char *name,
                             const char *body,
                             const char *x,
                             const char *y,
                             const char *z,
                             pc_error **error);

/**
 * Joins two bodies that hang by joints already: kind point, revolute or rod. `places` has 6
 * expressions: the point of the first in its axes, then that of the second.
 */
pc_status pc_model_add_loop(pc_model *model,
                            const char *name,
                            const char *kind,
                            const char *first,
                            const char *second,
                            const char *const *places,
                            pc_error **error);

/**
 * Sets the axis of a revolute loop, in axes of the first body and in those of the second, of 3
 * numbers each.
 */
pc_status pc_model_set_loop_axes(pc_model *model,
                                 const char *name,
                                 const double *first,
                                 const double *second,
                                 pc_error **error);

/**
 * Sets the distance of the two points of a rod.
 */
pc_status pc_model_set_loop_length(pc_model *model,
                                   const char *name,
                                   const char *length,
                                   pc_error **error);

/**
 * Sets a function S of time, coordinates and constants that is said to solve Hamilton–Jacobi's
 * equation, which pc_system_theory looks at. No motion needs it.
 */
pc_status pc_model_set_action(pc_model *model, const char *expression, pc_error **error);

/**
 * Adds a constant of the action, with a value near which the action is defined: where it is not
 * proved to solve the equation, numbers are tried there.
 */
pc_status pc_model_add_action_constant(pc_model *model,
                                       const char *name,
                                       double value,
                                       pc_error **error);

/**
 * Says what the model is.
 */
pc_status pc_model_set_description(pc_model *model, const char *description, pc_error **error);

/**
 * Says where the model comes from.
 */
pc_status pc_model_set_reference(pc_model *model, const char *reference, pc_error **error);

/**
 * Sets the value at the start of a coordinate, of a quasi-velocity, or of a velocity `x'` where
 * there are no quasi-velocities, to another number.
 */
pc_status pc_model_set_start(pc_model *model, const char *name, double value, pc_error **error);

/**
 * Sets the same to an expression of parameters.
 */
pc_status pc_model_set_start_expression(pc_model *model,
                                        const char *name,
                                        const char *expression,
                                        pc_error **error);

/**
 * Says of what kind a constraint is: "holonomic" or "nonholonomic", which is checked, or
 * "nonlinear" of one that is not affine in the velocities and obeys Chetaev's condition.
 */
pc_status pc_model_set_constraint_kind(pc_model *model,
                                       const char *constraint,
                                       const char *kind,
                                       pc_error **error);

/**
 * Sets the time at the start; 0 unless set.
 */
pc_status pc_model_set_start_time(pc_model *model, double t, pc_error **error);

/**
 * Sets the time to which the program `pc` runs the model. It is written to the text, as are the
 * next five; a solver is told by its own options.
 */
pc_status pc_model_set_end_time(pc_model *model, double t, pc_error **error);

/**
 * Sets the number of rows, from 2, that the program `pc` writes.
 */
pc_status pc_model_set_samples(pc_model *model, size_t samples, pc_error **error);

/**
 * Sets the tolerances with which the program `pc` runs the model, both positive.
 */
pc_status pc_model_set_tolerances(pc_model *model,
                                  double relative,
                                  double absolute,
                                  pc_error **error);

/**
 * Sets the largest length of a step, positive, with which the program `pc` runs the model: an
 * event whose function has passed through zero and back within a step is not seen.
 */
pc_status pc_model_set_max_step(pc_model *model, double length, pc_error **error);

/**
 * Sets how zeros of event functions are looked for by the program `pc`: at `samples_per_step`
 * places of each step, from 1, and events whose distances shrink geometrically to less than
 * `accumulation` of the first are taken for accumulated.
 */
pc_status pc_model_set_event_search(pc_model *model,
                                    size_t samples_per_step,
                                    double accumulation,
                                    pc_error **error);

/**
 * Sets the method by which the program `pc` runs the model: "adams", "bdf".
 */
pc_status pc_model_set_method(pc_model *model, const char *method, pc_error **error);

/**
 * Sets the form of the equations that the program `pc` integrates: "poincare", "canonical".
 */
pc_status pc_model_set_form(pc_model *model, const char *form, pc_error **error);

/**
 * A handle by which derivations and integrations are ended.
 */
pc_status pc_cancel_new(pc_cancel **cancel, pc_error **error);

/**
 * Ends the derivations and integrations under way with PC_LIMIT, soon, and those that begin later
 * at once. It takes no lock and allocates nothing, so that a handler of signals may call it,
 * which is all that one may. NULL is allowed.
 */
void pc_cancel_request(const pc_cancel *cancel);

/**
 * 1 after pc_cancel_request, else 0, as of NULL.
 */
int pc_cancel_is_requested(const pc_cancel *cancel);

/**
 * Frees a handle; what was given it goes on. Null is allowed.
 */
void pc_cancel_free(pc_cancel *cancel);

/**
 * Sets the options to their defaults. `size` is sizeof(pc_system_options). Null is allowed.
 */
void pc_system_options_init(pc_system_options *options, size_t size);

/**
 * Sets the options to their defaults. `size` is sizeof(pc_solver_options). Null is allowed.
 */
void pc_solver_options_init(pc_solver_options *options, size_t size);

/**
 * Derives and compiles the equations of a model. `options` may be NULL. This takes from
 * milliseconds to, for a hundred bodies, seconds; everything else is fast, except where it says
 * that it derives.
 */
pc_status pc_system_new(const pc_model *model,
                        const pc_system_options *options,
                        pc_system **system,
                        pc_error **error);

/**
 * A copy for another thread, with the parameters as they are now. It shares the machine code
 * there is: that of f, and that of each derivative which the original has evaluated before (the
 * first evaluation of each compiles it).
 */
pc_status pc_system_clone(const pc_system *system, pc_system **copy, pc_error **error);

/**
 * Frees a system. Null is allowed. In a function that is called by a call of this system it does
 * nothing.
 */
void pc_system_free(pc_system *system);

/**
 * The length of the state y: coordinates, quasi-velocities or momenta, first-order states. 0 of
 * NULL.
 */
size_t pc_system_dim(const pc_system *system);

/**
 * The number of coordinates, which come first in the state. 0 of NULL.
 */
size_t pc_system_coordinate_count(const pc_system *system);

/**
 * The number of first-order states, which come last in the state. 0 of NULL.
 */
size_t pc_system_state_count(const pc_system *system);

/**
 * The number of parameters. 0 of NULL.
 */
size_t pc_system_parameter_count(const pc_system *system);

/**
 * The number of observables: the integrals, "energy", the outputs. 0 of NULL.
 */
size_t pc_system_observable_count(const pc_system *system);

/**
 * The number of observables, the first ones, that should stay constant: integrals and energy. 0
 * of NULL.
 */
size_t pc_system_conserved_count(const pc_system *system);

/**
 * The number of constraints that are kept by projection. 0 of NULL.
 */
size_t pc_system_constraint_count(const pc_system *system);

/**
 * The number of reactions; 0 unless pc_model_observe_reactions was asked, and of NULL.
 */
size_t pc_system_reaction_count(const pc_system *system);

/**
 * The name of a component of the state, from 0; NULL beyond the last.
 */
const char *pc_system_name(const pc_system *system, size_t index);

/**
 * The name of a parameter, from 0; NULL beyond the last.
 */
const char *pc_system_parameter_name(const pc_system *system, size_t index);

/**
 * The name of an observable, from 0; NULL beyond the last.
 */
const char *pc_system_observable_name(const pc_system *system, size_t index);

/**
 * The name of a constraint that is kept by projection, from 0; NULL beyond the last.
 */
const char *pc_system_constraint_name(const pc_system *system, size_t index);

/**
 * The name of a reaction, `λ_` and that of its constraint, from 0; NULL beyond the last.
 */
const char *pc_system_reaction_name(const pc_system *system, size_t index);

/**
 * The time and state from which the model starts. `t` may be NULL.
 */
pc_status pc_system_start(const pc_system *system,
                          double *t,
                          double *y,
                          size_t y_length,
                          pc_error **error);

/**
 * The values of all parameters.
 */
pc_status pc_system_parameters(const pc_system *system,
                               double *values,
                               size_t length,
                               pc_error **error);

/**
 * Sets all parameters; cheap, nothing is derived again. The start stays, and solvers and kernels
 * made before keep their values. Inputs come after the parameters; those with a table are read
 * from it whatever they are set to.
 */
pc_status pc_system_set_parameters(pc_system *system,
                                   const double *values,
                                   size_t length,
                                   pc_error **error);

/**
 * Sets one parameter, by its place; those that are expressions in it follow, unless they have
 * been set themselves. Otherwise as pc_system_set_parameters.
 */
pc_status pc_system_set_parameter(pc_system *system, size_t index, double value, pc_error **error);

/**
 * Writes the place of a component of the state, from 0, by its name. PC_NOT_FOUND if there is
 * none of it.
 */
pc_status pc_system_find(const pc_system *system,
                         const char *name,
                         size_t *index,
                         pc_error **error);

/**
 * Writes the place of a parameter or input, from 0, by its name, as pc_system_find.
 */
pc_status pc_system_find_parameter(const pc_system *system,
                                   const char *name,
                                   size_t *index,
                                   pc_error **error);

/**
 * Writes the place of an observable, from 0, by its name, as pc_system_find.
 */
pc_status pc_system_find_observable(const pc_system *system,
                                    const char *name,
                                    size_t *index,
                                    pc_error **error);

/**
 * Declares that a force which a function of yours computes acts on a quasi-velocity; on a
 * coordinate if the model declares no quasi-velocities. It adds to what else acts there. The
 * function belongs to the system, not to the model: pc_system_set_force. An unknown name is
 * found by pc_model_check and pc_system_new.
 */
pc_status pc_model_add_external_force(pc_model *model, const char *on, pc_error **error);

/**
 * The number of external forces. 0 of NULL.
 */
size_t pc_system_force_count(const pc_system *system);

/**
 * The name of the quasi-velocity on which an external force acts, from 0; NULL beyond the last.
 */
const char *pc_system_force_name(const pc_system *system, size_t index);

/**
 * Sets the function that computes the external forces, all at once: the Q_s of the declared
 * quasi-velocities. Until then nothing that needs them can be evaluated. `jacobian` may be NULL:
 * the derivatives of the forces, and only these, are then difference quotients.
 *
 * Copies, kernels and solvers made from the system afterwards share the functions and `user`;
 * those made before keep what they had. The functions are called by whichever thread evaluates,
 * so by several at the same time if several use copies. They may call any function on other
 * handles, and of the same system pc_system_..._name and sizes.
 *
 * `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else
 * when the last handle that shares it is freed or given another function. It must not use a
 * handle that is being freed.
 */
pc_status pc_system_set_force(pc_system *system,
                              pc_force_function function,
                              pc_force_jacobian jacobian,
                              void *user,
                              pc_destroy destroy,
                              pc_error **error);

/**
 * Gives a quasi-velocity beside those of the model, for systems of the form PC_HAMEL: a linear
 * form in the velocities x' or the quasi-velocities of the model, such as "r*f'". Where those
 * given are fewer than the independent ones, quasi-velocities of the model complete them. Each
 * is an output too. What is wrong with it is found by pc_model_check and pc_system_new.
 */
pc_status pc_model_give_quasi_velocity(pc_model *model,
                                       const char *name,
                                       const char *definition,
                                       pc_error **error);

/**
 * Asks for a velocity as one of the independent ones, as many as the constraints leave free:
 * where multipliers would hold these, systems then have the equations in which they are
 * eliminated. The name is that of a quasi-velocity; x' where there are none. Without any,
 * equations in print and in source are those of the velocities that make them shortest. A wrong
 * choice is found by pc_system_new.
 */
pc_status pc_model_add_independent(pc_model *model, const char *name, pc_error **error);

/**
 * Writes the rate f(t, y) of the state to ydot.
 *
 * After the first call it takes no lock where f is one piece of machine code: where no function
 * of the program computes forces, M is not factorised in numbers, and no velocities are solved
 * for. Any number of threads may then call it at the same time and get its rates, those of the
 * parameters before or after where another one sets them. It is PC_BUSY, with anything in ydot,
 * only where that happens during its evaluation, and where it fails while the handle is in use.
 */
pc_status pc_system_rhs(const pc_system *system,
                        double t,
                        const double *y,
                        size_t y_length,
                        double *ydot,
                        size_t ydot_length,
                        pc_error **error);

/**
 * Writes ∂f/∂y, dim × dim and column-major, so `length` is dim*dim.
 */
pc_status pc_system_jacobian(const pc_system *system,
                             double t,
                             const double *y,
                             size_t y_length,
                             double *jacobian,
                             size_t length,
                             pc_error **error);

/**
 * Where ∂f/∂y may be other than zero, in compressed columns: the rows of the entries of column
 * j, ascending, are the numbers of row_indices from place column_starts(j) up to but without
 * place column_starts(j + 1). Gives pointers to dim + 1 and `entries` numbers that belong to the
 * system and its copies. Each of the three places may be NULL.
 */
pc_status pc_system_jacobian_pattern(const pc_system *system,
                                     size_t *entries,
                                     const size_t **column_starts,
                                     const size_t **row_indices,
                                     pc_error **error);

/**
 * Writes the entries of ∂f/∂y that pc_system_jacobian_pattern lists, in its order.
 */
pc_status pc_system_sparse_jacobian(const pc_system *system,
                                    double t,
                                    const double *y,
                                    size_t y_length,
                                    double *values,
                                    size_t length,
                                    pc_error **error);

/**
 * Writes the product (∂f/∂y) v; all three arrays have the length dim.
 */
pc_status pc_system_jvp(const pc_system *system,
                        double t,
                        const double *y,
                        size_t y_length,
                        const double *v,
                        size_t v_length,
                        double *product,
                        size_t product_length,
                        pc_error **error);

/**
 * Writes ∂f/∂p, dim × pc_system_parameter_count and column-major, so `length` is their product:
 * by each parameter while the others, also those that follow it, stay; by an input with a table
 * that by its values. PC_UNSUPPORTED unless pc_model_differentiate was asked, or there are
 * external forces.
 */
pc_status pc_system_parameter_jacobian(const pc_system *system,
                                       double t,
                                       const double *y,
                                       size_t y_length,
                                       double *jacobian,
                                       size_t length,
                                       pc_error **error);

/**
 * Writes ∂f/∂t, as long as the state, as Rosenbrock's methods take it. The first call derives, as
 * pc_system_new does, unless no expression of the model has t. PC_UNSUPPORTED with external
 * forces, of which it is not known, and with inputs that have tables.
 */
pc_status pc_system_time_derivative(const pc_system *system,
                                    double t,
                                    const double *y,
                                    size_t y_length,
                                    double *derivative,
                                    size_t length,
                                    pc_error **error);

/**
 * Moves the state, in place, to the constraints by the shortest way in the kinetic metric, and
 * the integrals of pc_model_keep to their values at the start of the model, or where
 * pc_system_keep_from said. Where there is nothing to be kept it stays.
 */
pc_status pc_system_project(const pc_system *system,
                            double t,
                            double *y,
                            size_t y_length,
                            pc_error **error);

/**
 * Has pc_system_project keep the integrals of pc_model_keep at their values at (t, y), moved to
 * the constraints, also after the parameters are set. Solvers keep those at their own start.
 */
pc_status pc_system_keep_from(pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              pc_error **error);

/**
 * Writes the observables at (t, y), as many as pc_system_observable_count: the integrals, the
 * energy, the outputs.
 *
 * An observable is not finite where the model has no value for it; one with accelerations in it,
 * also where external forces cannot be computed.
 */
pc_status pc_system_observe(const pc_system *system,
                            double t,
                            const double *y,
                            size_t y_length,
                            double *values,
                            size_t length,
                            pc_error **error);

/**
 * Writes the integrals and the energy at (t, y), as many as pc_system_conserved_count: what
 * should stay constant, which are the first of the observables.
 */
pc_status pc_system_integrals(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              double *values,
                              size_t length,
                              pc_error **error);

/**
 * Writes the energy y_s η_s − L at (t, y). No function of external forces is called.
 */
pc_status pc_system_energy(const pc_system *system,
                           double t,
                           const double *y,
                           size_t y_length,
                           double *energy,
                           pc_error **error);

/**
 * Writes the reactions of the constraints at (t, y), as many as pc_system_reaction_count: what
 * they add to the forces Q_s is the sum of each times the derivative of its constraint by η_s.
 */
pc_status pc_system_reactions(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              double *values,
                              size_t length,
                              pc_error **error);

/**
 * Writes what should be zero of each constraint that is kept by projection, as many as
 * pc_system_constraint_count.
 */
pc_status pc_system_constraint_residuals(const pc_system *system,
                                         double t,
                                         const double *y,
                                         size_t y_length,
                                         double *values,
                                         size_t length,
                                         pc_error **error);

/**
 * Adds an event: `when`, an expression, passes through zero in a direction, a pc_direction. A
 * `terminal` one, not 0, ends an integration with PC_EVENT. Simultaneous ones are dealt with in
 * the order in which they were added.
 */
pc_status pc_model_add_event(pc_model *model,
                             const char *name,
                             const char *when,
                             int direction,
                             int terminal,
                             pc_error **error);

/**
 * Gives an event that has been added a reset: where it occurs, the coordinate, quasi-velocity or
 * velocity `x'` that is called `variable` takes the value of the expression. All resets of an
 * event take effect together, from the state before it.
 */
pc_status pc_model_add_event_reset(pc_model *model,
                                   const char *event,
                                   const char *variable,
                                   const char *expression,
                                   pc_error **error);

/**
 * The number of events of the model. 0 of NULL.
 */
size_t pc_system_event_count(const pc_system *system);

/**
 * The name of an event, from 0; NULL beyond the last.
 */
const char *pc_system_event_name(const pc_system *system, size_t index);

/**
 * The direction of an event, a pc_direction; PC_BOTH beyond the last. These are the numbers that
 * CVODE's CVodeSetRootDirection takes.
 */
int pc_system_event_direction(const pc_system *system, size_t index);

/**
 * 1 if an event ends the integration, else 0.
 */
int pc_system_event_is_terminal(const pc_system *system, size_t index);

/**
 * 1 if an event resets the state, else 0.
 */
int pc_system_event_resets(const pc_system *system, size_t index);

/**
 * Writes the functions of the events at (t, y), as many as pc_system_event_count: an event
 * occurs where its own passes through zero. They are not finite where the model has no value for
 * them.
 */
pc_status pc_system_events(const pc_system *system,
                           double t,
                           const double *y,
                           size_t y_length,
                           double *values,
                           size_t length,
                           pc_error **error);

/**
 * Turns the state y before an event, number `event` from 0, into the state after it. One that
 * resets nothing leaves it as it is.
 */
pc_status pc_system_event_reset(const pc_system *system,
                                size_t event,
                                double t,
                                double *y,
                                size_t y_length,
                                pc_error **error);

/**
 * Writes the mass matrix M = ∂²L/∂η∂η at (t, y), k × k for the k quasi-velocities of the state,
 * so `length` is k*k; k is pc_system_dim less pc_system_coordinate_count and
 * pc_system_state_count. With multipliers their rows are not among it. The first call derives,
 * as pc_system_new does.
 */
pc_status pc_system_mass_matrix(const pc_system *system,
                                double t,
                                const double *y,
                                size_t y_length,
                                double *matrix,
                                size_t length,
                                pc_error **error);

/**
 * Writes the right-hand side r of M η̇ = r at (t, y), k numbers, k and M as of
 * pc_system_mass_matrix: all forces and gyroscopic terms, without the reactions of multipliers.
 * The first call derives, as pc_system_new does.
 */
pc_status pc_system_right_hand_side(const pc_system *system,
                                    double t,
                                    const double *y,
                                    size_t y_length,
                                    double *right,
                                    size_t length,
                                    pc_error **error);

/**
 * Solves M w = v at (t, y), M as of pc_system_mass_matrix, and writes w = M⁻¹ v; both have k
 * numbers. The first call derives, as pc_system_new does. PC_EVALUATION where M is singular.
 */
pc_status pc_system_solve_mass_matrix(const pc_system *system,
                                      double t,
                                      const double *y,
                                      size_t y_length,
                                      const double *v,
                                      size_t v_length,
                                      double *w,
                                      size_t w_length,
                                      pc_error **error);

/**
 * Writes the number K of operators X_1 … X_K between which there are structure coefficients: one
 * for each quasi-velocity of the state, then those that constraints say vanish, if any. The
 * first call derives, as pc_system_new does.
 */
pc_status pc_system_operator_count(const pc_system *system, size_t *operators, pc_error **error);

/**
 * Writes the structure coefficients of [X_r, X_s] = c_rs^m X_m, (5), at (t, y), for r, s = 0 …
 * K, with 0 for time, and m = 1 … K: c[(r*(K + 1) + s)*K + m - 1], so `length` is (K + 1)*(K +
 * 1)*K. The first call derives, as pc_system_new does.
 */
pc_status pc_system_structure_coefficients(const pc_system *system,
                                           double t,
                                           const double *y,
                                           size_t y_length,
                                           double *c,
                                           size_t length,
                                           pc_error **error);

/**
 * Writes the residual of the equations for ydot, as codes for implicit equations F(t, y, ẏ) = 0
 * take it: ẋ − b η − b_0, then M η̇ − r, where nothing is divided by M. With multipliers, whose
 * reactions are eliminated, the second part is M times the difference of η̇ from what it should
 * be; in the canonical form all is ẏ − f. The first call derives, as pc_system_new does.
 */
pc_status pc_system_residual(const pc_system *system,
                             double t,
                             const double *y,
                             size_t y_length,
                             const double *ydot,
                             size_t ydot_length,
                             double *residual,
                             size_t residual_length,
                             pc_error **error);

/**
 * Writes the Poisson bracket of coordinates and momenta (12) of two functions at (t, y),
 *
 *   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m,
 *
 * so that (x_i, H) = ẋ_i and (y_s, H) = ẏ_s where nothing depends on time and there are no
 * forces. The functions are expressions of the model, of coordinates and velocities; the momenta
 * y_s = ∂L/∂η_s are put in. Under nonholonomic constraints it is the almost-Poisson bracket of
 * the independent momenta. Each call derives, as pc_system_new does.
 */
pc_status pc_system_bracket(const pc_system *system,
                            const char *f,
                            const char *g,
                            double t,
                            const double *y,
                            size_t y_length,
                            double *value,
                            pc_error **error);

/**
 * Writes the state (x, p) with the momenta p_s = ∂L/∂η_s of the state (x, η). The first call
 * derives, as pc_system_new does.
 */
pc_status pc_system_to_momenta(const pc_system *system,
                               double t,
                               const double *y,
                               size_t y_length,
                               double *result,
                               size_t result_length,
                               pc_error **error);

/**
 * Writes the state (x, η) with the quasi-velocities of the state (x, p). The first call derives,
 * as pc_system_new does.
 */
pc_status pc_system_to_quasi_velocities(const pc_system *system,
                                        double t,
                                        const double *y,
                                        size_t y_length,
                                        double *result,
                                        size_t result_length,
                                        pc_error **error);

/**
 * Prints the equations, derived anew, as `pc derive` does: constraints, kinematics, brackets,
 * equations, energy and reactions, or momenta and Hamiltonian, and the operations of one
 * right-hand side. Where multipliers hold constraints, those of independent velocities are
 * shown. `format` is a pc_format. Parameters have the values of the model. Free the text with
 * pc_string_free.
 */
pc_status pc_system_print(const pc_system *system, int format, char **text, pc_error **error);

/**
 * Writes the equations as C source that depends on nothing of this library: the text of NAME.h
 * and of NAME.c, where NAME is `name`, spelt as an identifier: Greek letters by their names,
 * other signs as `_`, one at a time and not at the ends, `n_` before a digit at the beginning,
 * `_` behind a word of C. The source has the right-hand side, its Jacobian, the mass matrix, the
 * energy, the integrals and the outputs of independent quasi-velocities, those of its momenta
 * where the system has these, and says at its head how it is used. External forces are
 * parameters of it, after the others, called `Q_` and the name of their quasi-velocity, and stay
 * zero until they are set. If `t_end` is finite, it can be compiled with -DNAME_MAIN (in
 * capitals) to a program that integrates from the start of the model to that time. Free both
 * texts with pc_string_free.
 */
pc_status pc_system_emit_c(const pc_system *system,
                           const char *name,
                           double t_end,
                           char **header,
                           char **source,
                           pc_error **error);

/**
 * Prints what can be said of the motions without integrating them, as `pc theory` does: momenta
 * and their brackets, Casimirs, integrals, cyclic displacements, invariant measure, Chaplygin's
 * multiplier, Hamilton-Jacobi's equation, steady motions, Routh's reduction. What is claimed is
 * said to be proved, disproved or open. Integrals are looked for that are polynomials of a
 * `degree` from 1 to 6 in the velocities, whose coefficients are polynomials of the coordinates
 * times 1 or one of the `functions`, expressions of the model; there may be none of these.
 * `format` is a pc_format. Parameters have the values of the model. Everything is derived anew,
 * which takes longer than pc_system_print. Free the text with pc_string_free.
 */
pc_status pc_system_theory(const pc_system *system,
                           int format,
                           size_t degree,
                           const char *const *functions,
                           size_t function_count,
                           char **text,
                           pc_error **error);

/**
 * Derives the model a second time, by a route that shares only its text with the first, and
 * compares both at `states` random states on the constraints, for the parameters as they are
 * now: velocities, accelerations or rates of momenta, reactions, the energy and its rate,
 * integrals and outputs. 0 states are 100. `text` says how closely they agree and what was not
 * compared, in lines; it may be NULL, and is freed with pc_string_free. External forces are
 * taken for 0. PC_DISAGREEMENT, with the quantity and both its values, if one of the two is
 * wrong, which is a defect of the library; PC_UNSUPPORTED if the second cannot be made of this
 * model. It takes as long as pc_system_new.
 */
pc_status pc_system_verify(const pc_system *system, size_t states, char **text, pc_error **error);

/**
 * A kernel of the system with the parameters as they are now.
 */
pc_status pc_kernel_new(const pc_system *system, pc_kernel **kernel, pc_error **error);

/**
 * Frees a kernel. Null is allowed.
 */
void pc_kernel_free(pc_kernel *kernel);

/**
 * Sets all parameters of a kernel, in the order of pc_system_parameter_name.
 */
pc_status pc_kernel_set_parameters(pc_kernel *kernel,
                                   const double *values,
                                   size_t length,
                                   pc_error **error);

/**
 * Writes ydot = f(t, y), both of pc_system_dim numbers, which is not checked; they share no
 * memory. `kernel` is a pc_kernel of this thread's.
 *
 * Returns 0; 1 where f cannot be evaluated, so that a smaller step may help; −1 for what no step
 * helps. pc_system_rhs at the same (t, y) says why. It is the function that GSL's odeiv2 takes,
 * with the kernel as `params`.
 */
int pc_kernel_rhs(double t, const double *y, double *ydot, void *kernel);

/**
 * Writes ∂f/∂y, dim × dim and column-major; otherwise as pc_kernel_rhs. The first call compiles
 * it.
 */
int pc_kernel_jacobian(double t,
                       const double *y,
                       double *jacobian,
                       void *kernel);

/**
 * Writes f(t, y) of `count` states, which stand one after the other in `states`, to `rates`, in
 * the same order. Otherwise as pc_kernel_rhs: 1 if some cannot be evaluated, whose rates are not
 * numbers then; −1 for what no step helps, and the rates of those after it are not written.
 */
int pc_kernel_rhs_many(double t, const double *states, size_t count, double *rates, void *kernel);

/**
 * The dimension of a kernel's state. 0 of NULL.
 */
size_t pc_kernel_dim(const pc_kernel *kernel);

/**
 * An integration of the system from the state y at the time t, with the parameters as they are
 * now; from the start of the model if y is NULL, of length 0, and then t is not looked at.
 * `options` may be NULL. States stay on the constraints, and keep what pc_model_keep says, by
 * projection after each step; what is kept then are the values at this start. The events of the
 * model are followed: where one occurs, the state is reset as the model says, and a terminal one
 * ends the call with PC_EVENT.
 */
pc_status pc_solver_new(const pc_system *system,
                        const pc_solver_options *options,
                        double t,
                        const double *y,
                        size_t y_length,
                        pc_solver **solver,
                        pc_error **error);

/**
 * Frees a solver. Null is allowed. In its own observers and functions it does nothing.
 */
void pc_solver_free(pc_solver *solver);

/**
 * Has a solver go on with the parameters and inputs of the system as they are now, from where it
 * stands: it begins anew there, at order 1. So inputs are changed between two calls of
 * pc_solver_advance. The system is that of the solver, or one of the same model. PC_UNSUPPORTED
 * with events of pc_solver_add_event.
 */
pc_status pc_solver_take_parameters(pc_solver *solver, const pc_system *system, pc_error **error);

/**
 * Integrates to the time t, in the direction of the first step, and writes the state there. With
 * PC_EVENT and PC_STOPPED that is the state where it ended, and pc_solver_time tells when; the
 * next call goes on from there. After a failure pc_solver_time and pc_solver_state tell what was
 * reached; one of them is PC_LIMIT, by the time limit or the pc_cancel of the system's options.
 */
pc_status pc_solver_advance(pc_solver *solver,
                            double t,
                            double *y,
                            size_t y_length,
                            pc_error **error);

/**
 * Takes one internal step in the direction of `towards`, or the part of it before an event, and
 * writes its end, which may lie beyond, and the state there, also with PC_EVENT and PC_STOPPED.
 */
pc_status pc_solver_step(pc_solver *solver,
                         double towards,
                         double *t,
                         double *y,
                         size_t y_length,
                         pc_error **error);

/**
 * Integrates through the times, which go one way, and calls `observer` at each with the state,
 * which is valid during the call, and with `user`. PC_STOPPED if the observer stops it. At the
 * time of an event it is given the state after it; a terminal event is the last thing it is
 * given, at the time of that, and PC_EVENT is returned.
 */
pc_status pc_solver_run(pc_solver *solver,
                        const double *times,
                        size_t times_length,
                        pc_observer observer,
                        void *user,
                        pc_error **error);

/**
 * Writes the time at which the integration stands.
 */
pc_status pc_solver_time(const pc_solver *solver, double *t, pc_error **error);

/**
 * Writes the state at which the integration stands.
 */
pc_status pc_solver_state(const pc_solver *solver, double *y, size_t y_length, pc_error **error);

/**
 * Has an observer told of each event from now on, instead of the one before; of none if it is
 * NULL. `user` has to live until there is another one, or the solver is freed. It is called
 * within the calls that integrate, on their thread.
 */
pc_status pc_solver_observe_events(pc_solver *solver,
                                   pc_event_observer observer,
                                   void *user,
                                   pc_error **error);

/**
 * The same with a `user` that the solver owns: `destroy`, unless NULL, is called with it exactly
 * once: by this call if it fails or `observer` is NULL, else when another observer takes its
 * place or the solver is freed. It must not use the solver while that is being freed.
 */
pc_status pc_solver_set_event_observer(pc_solver *solver,
                                       pc_event_observer observer,
                                       void *user,
                                       pc_destroy destroy,
                                       pc_error **error);

/**
 * Follows an event of the program's own, after those of the model and those added before:
 * `function` passes through zero in a direction, a pc_direction. There `reset`, unless NULL,
 * changes the state, which is then projected to the constraints; a `terminal` event, not 0, ends
 * the call with PC_EVENT. Comes before the first step. `name` is for messages.
 *
 * `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else by
 * pc_solver_free. It must not use the solver.
 */
pc_status pc_solver_add_event(pc_solver *solver,
                              const char *name,
                              int direction,
                              int terminal,
                              pc_event_function function,
                              pc_event_reset reset,
                              void *user,
                              pc_destroy destroy,
                              pc_error **error);

/**
 * The number of events that a solver follows: those of the model, then those added. 0 of NULL.
 */
size_t pc_solver_event_count(const pc_solver *solver);

/**
 * The name of an event, from 0; NULL beyond the last.
 */
const char *pc_solver_event_name(const pc_solver *solver, size_t index);

/**
 * Writes how often an event has occurred since the solver was made.
 */
pc_status pc_solver_event_occurrences(const pc_solver *solver,
                                      size_t event,
                                      uint64_t *occurrences,
                                      pc_error **error);

/**
 * Writes when an event occurred last, and the states before and after. PC_NOT_FOUND if it has
 * not occurred. Only the last occurrence is kept; an observer sees all. `before` and `after` may
 * be NULL, of length 0.
 */
pc_status pc_solver_last_occurrence(const pc_solver *solver,
                                    size_t event,
                                    double *t,
                                    double *before,
                                    size_t before_length,
                                    double *after,
                                    size_t after_length,
                                    pc_error **error);

/**
 * Writes the number of the terminal event that ended the last call which integrated;
 * PC_NOT_FOUND if none did.
 */
pc_status pc_solver_terminal_event(const pc_solver *solver, size_t *event, pc_error **error);

/**
 * Writes the derivative of the start of the model by parameter number `parameter`, from 0: its
 * start values may be expressions in parameters. It derives the equations twice.
 * PC_INCONSISTENT_MODEL where there is no start for parameters near by, for an input with a
 * table, and for a parameter in whose expression others are.
 */
pc_status pc_system_start_by_parameter(const pc_system *system,
                                       size_t parameter,
                                       double *column,
                                       size_t column_length,
                                       pc_error **error);

/**
 * Has a solver integrate one more sensitivity with the motion, before the first step: the
 * derivative of the state by parameter number `parameter`, from 0, of a start with the
 * derivative `start`, as pc_system_start_by_parameter gives it for that of the model; NULL, of
 * length 0, for a start that does not depend on the parameter. The model has to be one of
 * pc_model_differentiate. Sensitivities jump where an event of the model resets the state;
 * PC_INVALID_ARGUMENT where an event of the program does. By an input with a table they are the
 * change when all its values are raised alike.
 */
pc_status pc_solver_add_sensitivity(pc_solver *solver,
                                    size_t parameter,
                                    const double *start,
                                    size_t start_length,
                                    pc_error **error);

/**
 * Writes sensitivity number `number`, from 0 in the order in which they were added, where the
 * integration stands, as long as the state.
 */
pc_status pc_solver_sensitivity(const pc_solver *solver,
                                size_t number,
                                double *column,
                                size_t column_length,
                                pc_error **error);

/**
 * Writes the derivative of y of the given order, 0 for y itself, at a time in the last internal
 * step, from the polynomial of the method, whose degree is the order of that step. The step
 * reaches from step_time − last_step to step_time of pc_statistics, but not beyond an event;
 * there is none before the first, nor after a reset. y is on the constraints, its derivatives
 * are those of the polynomial.
 */
pc_status pc_solver_interpolate(pc_solver *solver,
                                double t,
                                unsigned int derivative,
                                double *y,
                                size_t y_length,
                                pc_error **error);

/**
 * Integrates to the time t, which is not that of the solver, as pc_solver_advance does, and
 * keeps the motion from where it stood: (order + 2) × dim numbers for each internal step.
 * `dense` is made also with PC_EVENT and PC_STOPPED, and then ends there.
 */
pc_status pc_solver_run_dense(pc_solver *solver, double t, pc_dense **dense, pc_error **error);

/**
 * Writes y(t). At an event that is the state after it, but at the very end the limit from
 * before. Between the ends of steps it is off the constraints by the error of a step;
 * pc_system_project moves it there.
 */
pc_status pc_dense_eval(const pc_dense *dense,
                        double t,
                        double *y,
                        size_t y_length,
                        pc_error **error);

/**
 * Writes the rate of y at t, which may jump by the error of a step from one step to the next.
 */
pc_status pc_dense_rate(const pc_dense *dense,
                        double t,
                        double *ydot,
                        size_t ydot_length,
                        pc_error **error);

/**
 * The length of the state. 0 of NULL.
 */
size_t pc_dense_dim(const pc_dense *dense);

/**
 * Where the motion begins; NaN of NULL.
 */
double pc_dense_t_begin(const pc_dense *dense);

/**
 * Where the motion ends, before its beginning if it goes back in time; NaN of NULL.
 */
double pc_dense_t_end(const pc_dense *dense);

/**
 * Frees a motion. Null is allowed.
 */
void pc_dense_free(pc_dense *dense);

/**
 * Writes time and state of a solver as bytes, to be freed with pc_bytes_free and taken up by
 * pc_solver_restore, in another run of the program if you like. `label` says what it is a
 * checkpoint of; NULL for the empty text.
 *
 * A method rests on the steps before, so that this solver, too, begins anew there, at order 1:
 * from a checkpoint on, it and those restored go through the same numbers to the last bit.
 * Events of the model are part of it; PC_UNSUPPORTED with those of pc_solver_add_event.
 */
pc_status pc_solver_checkpoint(pc_solver *solver,
                               const char *label,
                               void **data,
                               size_t *length,
                               pc_error **error);

/**
 * An integration from a checkpoint, with the parameters of the system as they are now. It goes
 * on as the one did that was written if system, parameters and options are the same. `options`
 * may be NULL. PC_INVALID_CHECKPOINT unless the bytes are all that pc_solver_checkpoint wrote,
 * unchanged, and of a model with the same names and equations; values of parameters may differ.
 * The work of the solver is counted from there.
 */
pc_status pc_solver_restore(const pc_system *system,
                            const pc_solver_options *options,
                            const void *data,
                            size_t length,
                            pc_solver **solver,
                            pc_error **error);

/**
 * Writes the label of a checkpoint, to be freed with pc_string_free. PC_INVALID_CHECKPOINT as
 * pc_solver_restore.
 */
pc_status pc_checkpoint_label(const void *data, size_t length, char **label, pc_error **error);

/**
 * Frees bytes that a function of this library has written to be freed. Null is allowed.
 */
void pc_bytes_free(void *data);

/**
 * Writes the work so far. `size` is sizeof(pc_statistics).
 */
pc_status pc_solver_statistics(const pc_solver *solver,
                               pc_statistics *statistics,
                               size_t size,
                               pc_error **error);

/**
 * Integrates many members through the times, each from its own state, with its own parameters,
 * as a solver of its own would: the numbers are the same for any number of threads. The events
 * of the model are followed.
 *
 * `states` has members × dim numbers, member by member, at the time t; NULL for the start of the
 * model, and then t is not looked at. `parameters` has members × pc_system_parameter_count
 * numbers; NULL for those of the system as they are now. A length is 0 with NULL. `options` may
 * be NULL. `threads` is the number of threads, 0 for one on each core; they have ended when this
 * returns. A member that fails is told as any other, with what it reached, and the others go on.
 * What is the same for all, such as the times, is found by each. PC_STOPPED if the observer
 * stops it; PC_LIMIT, after those members that were finished, if the time limit or the pc_cancel
 * of the system's options ends it. The system may be used meanwhile.
 */
pc_status pc_ensemble_run(const pc_system *system,
                          const pc_solver_options *options,
                          size_t members,
                          double t,
                          const double *states,
                          size_t states_length,
                          const double *parameters,
                          size_t parameters_length,
                          const double *times,
                          size_t times_length,
                          size_t threads,
                          pc_member_observer observer,
                          void *user,
                          pc_error **error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PC_H */
