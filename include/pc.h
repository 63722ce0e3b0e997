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
 * Errors. A function that can fail returns a pc_status; its last argument is a place for a
 * pc_error, or NULL. On success it writes NULL there, otherwise a new error, which you free; what
 * the place held before does not matter. PC_STOPPED and PC_EVENT are not failures: an observer, or
 * a terminal event, has ended an integration. Results are written unless the call fails; after a
 * failure a new handle or text is NULL, and arrays for results may hold anything.
 *
 * Ownership. What a function named ..._new, ..._clone, pc_model_parse, pc_model_from_file,
 * pc_model_builtin, pc_code_load, pc_system_of_code, pc_solver_restore, pc_solver_run_dense or
 * pc_system_linearization gives, you free with the ..._free of its type; `char *` you free with
 * pc_string_free, bytes with pc_bytes_free; `const char *` belongs to the handle it came from and
 * lives as long, or is static. All ..._free allow NULL.
 * Handles are independent: a model can be freed while its system lives, and a system while its
 * solvers and kernels do.
 *
 * Arrays. Each comes with its length, which must be exact, not merely large enough. They are
 * `double`, aligned as such, and an array that is written must not overlap another one; this is
 * checked. NULL goes with the length 0. Matrices are dense and column-major, A[i + j*rows],
 * unless the function says otherwise. Text is UTF-8 and zero-terminated.
 *
 * Threads. Nothing is global. A handle may go from thread to thread and is used by one call at a
 * time: a second one at the same time returns PC_BUSY and does nothing. Only pc_system_rhs may
 * run many times side by side, as it says. (Freeing a handle while another thread uses it is not
 * safe.) Different handles are independent; to evaluate on many threads, give each its own by
 * pc_system_of_code or pc_system_clone, or a pc_kernel, which is the one handle that does not
 * notice a second call. Any number of threads may read names and sizes, and use a pc_cancel, a
 * pc_code and a pc_dense, at any time. A `const`
 * handle says only that the call does not change what the handle computes.
 *
 * Signal handlers may call pc_cancel_request only. A fault of the library is PC_INTERNAL and does
 * not end your program; exhausted memory or an exhausted stack does. A thread needs a stack of
 * 128 KiB, whatever the model; deeper derivations run on a separate stack of 8 MiB.
 */

#ifndef PC_H
#define PC_H

#include <stddef.h>
#include <stdint.h>

#if !defined(PC_API)
  #if defined(_WIN32) && !defined(PC_STATIC)
    /* Comes from pc.dll; define PC_STATIC where the static library is linked instead. */
    #define PC_API __declspec(dllimport)
  #elif !defined(_WIN32) && defined(__GNUC__)
    #define PC_API __attribute__((visibility("default")))
  #else
    #define PC_API
  #endif
#endif

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * First number of the header's version.
 */
#define PC_VERSION_MAJOR 0

/**
 * Second number of the header's version.
 */
#define PC_VERSION_MINOR 1

/**
 * Third number of the header's version.
 */
#define PC_VERSION_PATCH 0

/**
 * The header's version as one number, major × 10000 + minor × 100 + patch.
 */
#define PC_VERSION_NUMBER 100

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
   * The text of the model is wrong, or not UTF-8; the error says where.
   */
  PC_INVALID_MODEL = 2,
  /**
   * The model contradicts itself; the error says where.
   */
  PC_INCONSISTENT_MODEL = 3,
  /**
   * The request cannot be met, at least not for this system.
   */
  PC_UNSUPPORTED = 4,
  /**
   * Nothing has this name: no file, no component, no event.
   */
  PC_NOT_FOUND = 5,
  /**
   * A file exists but could not be read.
   */
  PC_IO = 6,
  /**
   * The equations cannot be evaluated at this time and state.
   */
  PC_EVALUATION = 7,
  /**
   * The integration could not begin or continue. Events that accumulate, such as the bounces
   * of a ball that comes to rest, end it in this way.
   */
  PC_INTEGRATION = 8,
  /**
   * An observer stopped the integration. This is not a failure, and there is no pc_error.
   */
  PC_STOPPED = 9,
  /**
   * The handle is in use: by another thread, or by the call from which the observer or the force
   * function was called.
   */
  PC_BUSY = 10,
  /**
   * A fault of the library, after which the handle can only be freed; or else threads or memory
   * for a solver are not available, and the handle is unchanged.
   */
  PC_INTERNAL = 11,
  /**
   * A terminal event ended the integration. This is not a failure, and there is no pc_error.
   */
  PC_EVENT = 12,
  /**
   * The bytes are not a checkpoint, or part of it is missing or changed.
   */
  PC_INVALID_CHECKPOINT = 13,
  /**
   * Two derivations of one model give different motions: a defect of the library.
   */
  PC_DISAGREEMENT = 14,
  /**
   * The derivation or an integration would exceed its limit of memory or time, or was cancelled.
   */
  PC_LIMIT = 15,
  /**
   * The bytes are not a code, or those of another layout, or part of them is missing or changed.
   */
  PC_INVALID_CODE = 16,
  /**
   * Not a status.
   */
  PC_STATUS_LAST = 2147483647,
} pc_status;

/**
 * The form of the equations of motion; values of pc_system_options.form.
 */
typedef enum {
  /**
   * Poincaré's equations, in quasi-velocities: in the independent ones if constraints make the
   * others vanish, otherwise in all of them, with multipliers.
   */
  PC_POINCARE = 0,
  /**
   * Chetaev's canonical equations, in momenta.
   */
  PC_CANONICAL = 1,
  /**
   * Poincaré's equations without the coordinates on which nothing depends, and Euler–Poincaré's
   * where no coordinate is left; the state has fewer coordinates. Where constraints are imposed
   * by multipliers, this form and those below give PC_INCONSISTENT_MODEL, unless
   * pc_model_add_independent says which velocities are independent.
   */
  PC_REDUCED = 2,
  /**
   * The same equations in momenta: Lie–Poisson equations.
   */
  PC_LIE_POISSON = 3,
  /**
   * Poincaré's equations, in quasi-velocities that are orthonormal in the kinetic metric.
   */
  PC_ORTHONORMAL = 4,
  /**
   * Hamel's equations, in the quasi-velocities of pc_model_give_quasi_velocity.
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
  /**
   * The explicit Runge–Kutta method of order 8 of Dormand and Prince, for systems that are
   * not stiff at tolerances of 1e-6 and below: the fastest where the equations are short. It has
   * no sensitivities, and offers no choice of iteration, linear solver or highest order.
   */
  PC_DOP853 = 2,
  /**
   * Taylor's method of adaptive order and step, for systems that are not stiff: the fastest at
   * tolerances of 1e-8 and below, and the one that follows a motion to within rounding errors.
   * It needs equations that are solved symbolically, without tables and without forces from
   * functions of the program.
   */
  PC_TAYLOR = 3,
  /**
   * PC_DOP853 where the motion is not stiff, PC_BDF where stiffness is detected. With
   * sensitivities it is PC_ADAMS.
   */
  PC_AUTO = 4,
} pc_method;

/**
 * How the equation of a step is solved; values of pc_solver_options.iteration.
 */
typedef enum {
  /**
   * Newton's iteration for PC_BDF, also within PC_AUTO, and the fixed-point iteration for
   * PC_ADAMS.
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
   * Matrix-free GMRES.
   */
  PC_LINEAR_KRYLOV = 3,
} pc_linear_solver;

/**
 * The format in which equations are printed.
 */
typedef enum {
  /**
   * As they appear in a book, in UTF-8.
   */
  PC_TEXT = 0,
  /**
   * LaTeX displays that use amsmath.
   */
  PC_LATEX = 1,
  /**
   * One JSON object, for programs.
   */
  PC_JSON = 2,
} pc_format;

/**
 * The direction in which the function of an event passes through zero, along the integration.
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
 * What a component of the state has to satisfy; values of pc_solver_options.inequalities.
 */
typedef enum {
  /**
   * Nothing.
   */
  PC_FREE = 0,
  /**
   * ≥ 0
   */
  PC_NOT_NEGATIVE = 1,
  /**
   * ≤ 0
   */
  PC_NOT_POSITIVE = -1,
  /**
   * > 0
   */
  PC_POSITIVE = 2,
  /**
   * < 0
   */
  PC_NEGATIVE = -2,
} pc_inequality;

/**
 * About which state pc_system_linearization linearises.
 */
typedef enum {
  /**
   * The state that is given; it has to satisfy the constraints.
   */
  PC_ABOUT_STATE = 0,
  /**
   * The steady motion nearest to it by Newton's method, in which all rates vanish but those of
   * cyclic coordinates.
   */
  PC_ABOUT_STEADY = 1,
  /**
   * The equilibrium nearest to it, with all quasi-velocities 0.
   */
  PC_ABOUT_REST = 2,
} pc_about;

/**
 * The lists of a linearization, and its matrices by their rows and columns.
 */
typedef enum {
  /**
   * The components x, which are names of components of the state.
   */
  PC_LINEAR_COMPONENTS = 0,
  /**
   * u: the external forces, then the parameters that were chosen.
   */
  PC_LINEAR_INPUTS = 1,
  /**
   * h: the outputs of the model that have derivatives at the state.
   */
  PC_LINEAR_OUTPUTS = 2,
} pc_linear_part;

/**
 * The matrices of a linearization.
 */
typedef enum {
  /**
   * A, by components and components.
   */
  PC_LINEAR_A = 0,
  /**
   * B, by components and inputs.
   */
  PC_LINEAR_B = 1,
  /**
   * C, by outputs and components.
   */
  PC_LINEAR_C = 2,
  /**
   * D, by outputs and inputs.
   */
  PC_LINEAR_D = 3,
  /**
   * The eigenvalues of A, two columns: real and imaginary parts, by components.
   */
  PC_LINEAR_EIGENVALUES = 4,
} pc_linear_matrix;

/**
 * A handle that ends the derivations of systems whose pc_system_options contain it, and the
 * integrations of these systems. Any number of threads may use it at the same time. Free it with
 * pc_cancel_free.
 */
typedef struct pc_cancel pc_cancel;

/**
 * The equations of motion of a model, derived and compiled: what all its systems have in
 * common. It never changes, so any number of threads may use it. Free it with pc_code_free.
 */
typedef struct pc_code pc_code;

/**
 * A motion as a function of time. It never changes, so any number of threads may use it. Free it
 * with pc_dense_free.
 */
typedef struct pc_dense pc_dense;

/**
 * Why a call failed: the status, the message and, for a model, the position in its text. It never
 * changes; free it with pc_error_free.
 */
typedef struct pc_error pc_error;

/**
 * f(t, y) for an integrator of your own: the context of pc_kernel_rhs and pc_kernel_jacobian.
 * Free it with pc_kernel_free.
 *
 * It holds workspace, so each thread needs its own kernel, and two calls at the same time are not
 * safe; in return it takes no locks.
 */
typedef struct pc_kernel pc_kernel;

/**
 * The linear equations near a state, δẋ = A δx + B δu, δh = C δx + D δu, in independent
 * components x of the states that satisfy the constraints. It never changes. Free it with
 * pc_linearization_free.
 */
typedef struct pc_linearization pc_linearization;

/**
 * A model: parameters, frame, energy, forces, constraints, start. Free it with pc_model_free.
 */
typedef struct pc_model pc_model;

/**
 * An integration, with its current time and state. Free it with pc_solver_free.
 */
typedef struct pc_solver pc_solver;

/**
 * The equations of motion of a model, compiled: ẏ = f(t, y). Free it with pc_system_free.
 */
typedef struct pc_system pc_system;

/**
 * Options for deriving a system. Set them up with pc_system_options_init.
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
   * Reserved; must be 0.
   */
  int reserved;
  /**
   * Maximum number of bytes, by estimate, that the expressions of a derivation may take; 0, the
   * default, for 4 GiB. Beyond it a call returns PC_LIMIT. The limit applies separately to
   * pc_system_new and to each later call that derives; so do the next two fields.
   */
  uint64_t memory_limit;
  /**
   * Maximum time in seconds, positive, for a derivation and for each call of a solver or an
   * ensemble of the system; 0, the default, for no limit.
   */
  double time_limit;
  /**
   * The handle with which derivations and integrations can be ended; NULL, the default, for
   * none. The handle may be freed when pc_system_new has returned.
   */
  const pc_cancel *cancel;
} pc_system_options;

/**
 * Options for an integration. Set them up with pc_solver_options_init, then change what you like.
 */
typedef struct {
  /**
   * sizeof(pc_solver_options), set by pc_solver_options_init.
   */
  size_t size;
  /**
   * A pc_method; PC_AUTO by default.
   */
  int method;
  /**
   * A pc_iteration; PC_ITERATION_OF_METHOD by default.
   */
  int iteration;
  /**
   * A pc_linear_solver; PC_LINEAR_AUTOMATIC by default. It matters only with Newton's iteration.
   */
  int linear_solver;
  /**
   * Highest order of the method; 0, the default, for the highest it has.
   */
  int max_order;
  /**
   * Relative tolerance, positive; 1e-9 by default.
   */
  double relative_tolerance;
  /**
   * Absolute tolerance for all components, positive; 1e-12 by default.
   */
  double absolute_tolerance;
  /**
   * Absolute tolerances, one for each component, copied; NULL, the default, for the one above.
   */
  const double *absolute_tolerances;
  /**
   * The number of these tolerances; 0 with NULL.
   */
  size_t absolute_tolerances_length;
  /**
   * Maximum number of steps from one output to the next; 500000 by default.
   */
  uint64_t max_steps;
  /**
   * Length of the first step, positive in both directions of time; 0, the default, for an
   * estimate.
   */
  double initial_step;
  /**
   * Minimum length of a step; 0, the default, for none.
   */
  double min_step;
  /**
   * Maximum length of a step; 0, the default, for none.
   */
  double max_step;
  /**
   * A time beyond which the equations are never evaluated; infinity, the default, for none.
   */
  double stop_time;
  /**
   * Number of equal parts of each step, at least 1; 4 by default. Functions of events that are
   * not expressions in the state alone (those of your program, and those that are read through
   * constraints, momenta or tables) are sampled at the ends of the parts, and more closely where
   * the values leave doubt. Between two such times an even number of zeros may be missed.
   */
  uint32_t samples_per_step;
  /**
   * Reserved; must be 0.
   */
  uint32_t reserved;
  /**
   * Events that follow each other ever faster are an error once the time left until they
   * accumulate is this fraction of their first interval, at least 0 (never) and less than
   * 1; 1e-5 by default.
   */
  double accumulation;
  /**
   * A pc_inequality for each component of the state, copied; NULL, the default, for none. They
   * hold at the ends of steps; a component that cannot satisfy its inequality ends the
   * integration. A start that does not satisfy them is refused, and so are inequalities with
   * PC_TAYLOR, and for systems whose states are projected.
   */
  const int *inequalities;
  /**
   * The number of these inequalities; 0 with NULL.
   */
  size_t inequalities_length;
} pc_solver_options;

/**
 * Writes the external forces at (t, y) to q: one for each that was declared, in the order of the
 * declarations, so `q_length` is pc_system_force_count. y is the state of the system; in the
 * canonical form it contains momenta. Returns 0 on success; a positive number where the forces are
 * not defined, so that a smaller step may help; a negative number to give up. A force left
 * unwritten is NaN and is treated like a positive return value. It must return normally: no
 * exceptions, no longjmp.
 */
typedef int (*pc_force_function)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *q,
                                 size_t q_length,
                                 void *user);

/**
 * Writes the derivatives of the external forces at (t, y), all of them, column-major: ∂q_i/∂y_j
 * to `dq[i + j*e]` for e forces, so `dq_length` is e * `y_length`. Otherwise it is like
 * pc_force_function.
 */
typedef int (*pc_force_jacobian)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *dq,
                                 size_t dq_length,
                                 void *user);

/**
 * Frees the data to which the `user` of a function points. It must return normally: no exceptions,
 * no longjmp.
 */
typedef void (*pc_destroy)(void *user);

/**
 * Receives the state at each output time. Returns 0 to continue; anything else ends the run
 * with PC_STOPPED. It may call any function on other handles, and must return normally: no
 * exceptions, no longjmp.
 */
typedef int (*pc_observer)(double t, const double *y, size_t y_length, void *user);

/**
 * Receives the end (t, y) of each internal step, or of the part of a step before an event, where
 * y is the state before the event; the order of the method in this step, and the length of the
 * step, with the sign of the direction. It may lie beyond the time to which the call integrates.
 * Returns 0 to continue; anything else ends the call with PC_STOPPED. Otherwise it is like
 * pc_observer.
 */
typedef int (*pc_monitor)(double t,
                          const double *y,
                          size_t y_length,
                          int order,
                          double step,
                          void *user);

/**
 * Receives each event where it occurs, by its number among the events of the solver, with the
 * states before and after it, which are valid during the call. Each of several simultaneous events
 * is given with the state that it found and the state that it left. Returns 0 to continue;
 * anything else ends the call with PC_STOPPED, or with PC_EVENT where the event is terminal.
 * Otherwise it is like pc_observer.
 */
typedef int (*pc_event_observer)(size_t event,
                                 double t,
                                 const double *before,
                                 const double *after,
                                 size_t y_length,
                                 void *user);

/**
 * Writes g(t, y), which passes through zero where the event occurs. Returns 0; anything else
 * ends the integration with PC_INTEGRATION, as does a value that is not finite or not
 * written. It should depend only on its arguments and be smooth. It must return normally: no
 * exceptions, no longjmp.
 */
typedef int (*pc_event_function)(double t,
                                 const double *y,
                                 size_t y_length,
                                 double *value,
                                 void *user);

/**
 * Turns the state y before the event into the state after it. Otherwise it is like
 * pc_event_function.
 */
typedef int (*pc_event_reset)(double t, double *y, size_t y_length, void *user);

/**
 * Counters since the start of an integration, and data on its last internal step. The structure
 * may grow at the end.
 */
typedef struct {
  /**
   * Internal steps.
   */
  uint64_t steps;
  /**
   * Evaluations of f, including those for difference quotients.
   */
  uint64_t rhs_evaluations;
  /**
   * Evaluations of ∂f/∂y.
   */
  uint64_t jacobian_evaluations;
  /**
   * Steps repeated because the estimated error was too large.
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
   * Factorisations, or updates of the preconditioner.
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
   * Length with which the next step is tried.
   */
  double next_step;
  /**
   * End of the last step, which may lie beyond the time of the solver.
   */
  double step_time;
  /**
   * Steps shortened to end where the equations, as explicit functions of time, change in a way
   * of which the motion so far gives no hint, as at a jump or at the beginning of a pulse.
   */
  uint64_t limited_steps;
  /**
   * Steps that PC_AUTO made with PC_BDF.
   */
  uint64_t implicit_steps;
  /**
   * How often PC_AUTO switched between its methods.
   */
  uint64_t changes;
  /**
   * Time at which PC_DOP853 or PC_AUTO first found the motion to be stiff; NaN if never.
   */
  double stiff_from;
} pc_statistics;

/**
 * The result of a member of an ensemble. The structure may grow at the end.
 */
typedef struct {
  /**
   * The number of the member, counted from 0.
   */
  size_t number;
  /**
   * PC_OK, PC_EVENT if a terminal event ended the motion, or the status of the failure.
   */
  pc_status status;
  /**
   * Why the member failed; NULL if it did not.
   */
  const char *message;
  /**
   * The output times that the member reached, as many as `rows`; the time of a terminal event is
   * the last one.
   */
  const double *times;
  /**
   * The states at these times, one after the other, each of `dim` numbers. Like `times`, it is
   * NULL where there are none.
   */
  const double *states;
  /**
   * The number of these times and states, even if the member failed.
   */
  size_t rows;
  /**
   * The length of a state.
   */
  size_t dim;
} pc_member;

/**
 * Receives each member in order, on the thread of the call; the data to which `member` points are
 * valid during the call. Returns 0 to continue; anything else ends the ensemble with PC_STOPPED.
 * Otherwise it is like pc_observer.
 */
typedef int (*pc_member_observer)(const pc_member *member, void *user);

/**
 * The version of the library, such as "0.1.0". The text is static.
 */
PC_API const char *pc_version(void);

/**
 * The version of the library as one number, such as 100 for 0.1.0: what PC_VERSION_NUMBER is for
 * the header.
 */
PC_API uint32_t pc_version_number(void);

/**
 * The PC_ABI_VERSION of the library that is in use.
 */
PC_API uint32_t pc_abi_version(void);

/**
 * The name of a status, such as "PC_OK"; "unknown status" for any other number. Static.
 */
PC_API const char *pc_status_name(int status);

/**
 * The status of the failed call, never PC_OK; PC_OK for NULL.
 */
PC_API pc_status pc_error_status(const pc_error *error);

/**
 * The message, in UTF-8, never NULL; it lives as long as the error. For a model it shows the line
 * at fault and what would be correct, on several lines. Empty for NULL.
 */
PC_API const char *pc_error_message(const pc_error *error);

/**
 * The line of the model text at fault, counted from 1; 0 if there is none, and for NULL.
 */
PC_API size_t pc_error_line(const pc_error *error);

/**
 * The column at which the offending text begins, in characters counted from 1; 0 if there is none,
 * and for NULL.
 */
PC_API size_t pc_error_column(const pc_error *error);

/**
 * The byte at which the offending text begins, counted from 0; 0 if there is none, and for NULL.
 */
PC_API size_t pc_error_offset(const pc_error *error);

/**
 * The number of bytes of the text at fault; 0 if there is none, and for NULL.
 */
PC_API size_t pc_error_length(const pc_error *error);

/**
 * The code that CVODES returned (cvodes.h), if that is the reason; 0 otherwise, and for NULL.
 */
PC_API int pc_error_integrator_code(const pc_error *error);

/**
 * 1 if the status is PC_EVALUATION and evaluation may succeed at a nearby state, so that an
 * integrator should try a smaller step; 0 otherwise, and for NULL.
 */
PC_API int pc_error_is_recoverable(const pc_error *error);

/**
 * Frees an error. NULL is allowed.
 */
PC_API void pc_error_free(pc_error *error);

/**
 * Frees a text that a function of this library returned for the caller to free. NULL is allowed.
 */
PC_API void pc_string_free(char *text);

/**
 * Reads a model from `length` bytes of text, which need no zero at the end. Messages call the
 * model `name`; NULL means "model".
 */
PC_API
pc_status pc_model_parse(const char *text,
                         size_t length,
                         const char *name,
                         pc_model **model,
                         pc_error **error);

/**
 * Reads a model from a file.
 */
PC_API pc_status pc_model_from_file(const char *path, pc_model **model, pc_error **error);

/**
 * Reads a robot in URDF with macros expanded, in MJCF or in SDF, as a model of bodies on joints.
 * `floating`: whether the root link of a robot in URDF moves freely; otherwise it stands still.
 * `fix_massless`: whether joints that move no mass are fixed; otherwise they are refused. What a
 * model cannot express is left out, and said in comments at the head of the text, which
 * pc_model_text gives.
 */
PC_API
pc_status pc_model_from_robot(const char *path,
                              int floating,
                              int fix_massless,
                              pc_model **model,
                              pc_error **error);

/**
 * Reads a model that comes with the library, such as "heavy-top-lagrange".
 */
PC_API pc_status pc_model_builtin(const char *name, pc_model **model, pc_error **error);

/**
 * The number of models that come with the library.
 */
PC_API size_t pc_builtin_count(void);

/**
 * The name of a model that comes with the library, counted from 0; NULL beyond the last. Static.
 */
PC_API const char *pc_builtin_name(size_t index);

/**
 * Copies a model; either can be changed independently.
 */
PC_API pc_status pc_model_clone(const pc_model *model, pc_model **copy, pc_error **error);

/**
 * Frees a model. NULL is allowed.
 */
PC_API void pc_model_free(pc_model *model);

/**
 * Sets a parameter of the model to another value.
 */
PC_API pc_status pc_model_set(pc_model *model, const char *name, double value, pc_error **error);

/**
 * Makes projection keep this integral, or "energy", at its value at the start: after each step of
 * a solver, and in pc_system_project. An unknown name is reported by pc_system_new.
 */
PC_API pc_status pc_model_keep(pc_model *model, const char *integral, pc_error **error);

/**
 * Sets whether the start is moved onto the constraints (otherwise a start that violates them is
 * refused). Any value but 0 means yes.
 */
PC_API pc_status pc_model_project_start(pc_model *model, int yes, pc_error **error);

/**
 * Holds the start value of this coordinate or quasi-velocity fixed while the others are moved to
 * satisfy the constraints. Without pc_model_project_start it has no effect. An unknown name is
 * reported by pc_system_new, with PC_NOT_FOUND.
 */
PC_API pc_status pc_model_hold_start(pc_model *model, const char *name, pc_error **error);

/**
 * Sets whether the reactions of the constraints are observed; the name of each is `λ_` followed by
 * that of its constraint. Any value but 0 means yes.
 */
PC_API
pc_status pc_model_observe_reactions(pc_model *model,
                                     int yes,
                                     pc_error **error);

/**
 * Sets whether systems of the model are derived with their derivatives with respect to parameters,
 * which pc_solver_add_sensitivity needs. Any value but 0 means yes.
 */
PC_API pc_status pc_model_differentiate(pc_model *model, int yes, pc_error **error);

/**
 * Gives the text of the model, to be freed with pc_string_free. For a model built by calls it is
 * the text that the calls wrote; errors refer to its lines and columns. Settings that cannot be
 * expressed in the text format are omitted: parameters set by pc_model_set, a start set by
 * pc_model_set_start for a model that was read, and the settings of pc_model_keep,
 * pc_model_project_start, pc_model_hold_start, pc_model_observe_reactions, pc_model_differentiate,
 * pc_model_add_external_force, pc_model_give_quasi_velocity, pc_model_add_independent.
 */
PC_API pc_status pc_model_text(const pc_model *model, char **text, pc_error **error);

/**
 * Makes an empty model, to be built by the calls below. Entries of different kinds may be added in
 * any order; coordinates, quasi-velocities, parameters and so on each keep the order of their
 * calls. Expressions are written as in the text of a model: `x'` is the velocity of the coordinate
 * x, and `t` is the time. The model is read as a whole by pc_model_check and pc_system_new, whose
 * errors name the entry and show its expression.
 */
PC_API pc_status pc_model_new(const char *name, pc_model **model, pc_error **error);

/**
 * Reads the model as a whole: returns PC_OK if all names are known, all expressions are well
 * formed, and the frame and the start are valid. Only pc_system_new shows whether equations can be
 * derived.
 */
PC_API pc_status pc_model_check(const pc_model *model, pc_error **error);

/**
 * Adds a parameter with its value, which pc_model_set and pc_system_set_parameter can change.
 */
PC_API
pc_status pc_model_add_parameter(pc_model *model,
                                 const char *name,
                                 double value,
                                 pc_error **error);

/**
 * Adds a parameter that is an expression in the parameters before it. The new parameter changes
 * with them until it is itself set.
 */
PC_API
pc_status pc_model_add_parameter_expression(pc_model *model,
                                            const char *name,
                                            const char *expression,
                                            pc_error **error);

/**
 * Adds a first-order state with its value at the start and its rate, which is an expression in
 * time, coordinates, velocities and states. The first-order state is integrated with the motion
 * and comes after the velocities in the state; it is not part of the frame.
 */
PC_API
pc_status pc_model_add_state(pc_model *model,
                             const char *name,
                             const char *rate,
                             double start,
                             pc_error **error);

/**
 * Sets the components of the acceleration of gravity, along the axes in which the positions of
 * bodies are given, as expressions in the parameters and t. Gravity acts on the mass centres of
 * all bodies and is included in the energy.
 */
PC_API
pc_status pc_model_set_gravity(pc_model *model,
                               const char *x,
                               const char *y,
                               const char *z,
                               pc_error **error);

/**
 * Adds a name for an expression.
 */
PC_API
pc_status pc_model_add_definition(pc_model *model,
                                  const char *name,
                                  const char *expression,
                                  pc_error **error);

/**
 * Adds a coordinate with its value at the start.
 */
PC_API
pc_status pc_model_add_coordinate(pc_model *model,
                                  const char *name,
                                  double start,
                                  pc_error **error);

/**
 * Adds a quasi-velocity with its value at the start. Its `definition` is an expression affine in
 * the velocities x', or NULL where pc_model_set_kinematics gives the velocities in terms of
 * quasi-velocities. A model without quasi-velocities uses the velocities themselves; `name` may
 * then be `x'`, which sets the start value of this velocity.
 */
PC_API
pc_status pc_model_add_quasi_velocity(pc_model *model,
                                      const char *name,
                                      const char *definition,
                                      double start,
                                      pc_error **error);

/**
 * Sets the velocity of a coordinate as an expression affine in the quasi-velocities, (3). Call
 * this function for every coordinate, or for none.
 */
PC_API
pc_status pc_model_set_kinematics(pc_model *model,
                                  const char *coordinate,
                                  const char *velocity,
                                  pc_error **error);

/**
 * Sets the brackets of the frame to those of the algebra with this name, such as "so3"; needed
 * only where the frame does not determine them.
 */
PC_API pc_status pc_model_set_algebra(pc_model *model, const char *name, pc_error **error);

/**
 * Sets the bracket [X_left, X_right], (5), as a linear combination of quasi-velocities, such as
 * "w3"; brackets that are not set are zero. `left` may be "t", for X_0. This is an alternative to
 * pc_model_set_algebra.
 */
PC_API
pc_status pc_model_set_bracket(pc_model *model,
                               const char *left,
                               const char *right,
                               const char *value,
                               pc_error **error);

/**
 * Adds a constraint: the expression, in coordinates or in velocities, must vanish. If it is not
 * affine in the velocities, declare this with pc_model_set_constraint_kind.
 */
PC_API
pc_status pc_model_add_constraint(pc_model *model,
                                  const char *name,
                                  const char *expression,
                                  pc_error **error);

/**
 * Sets the Lagrangian L(t, x, η), which may contain x' too. It cannot be combined with a kinetic
 * or potential energy.
 */
PC_API
pc_status pc_model_set_lagrangian(pc_model *model,
                                  const char *expression,
                                  pc_error **error);

/**
 * Sets the kinetic energy.
 */
PC_API pc_status pc_model_set_kinetic(pc_model *model, const char *expression, pc_error **error);

/**
 * Sets the potential energy.
 */
PC_API pc_status pc_model_set_potential(pc_model *model, const char *expression, pc_error **error);

/**
 * Sets a dissipation function R, which gives the forces Q_s = −∂R/∂η_s.
 */
PC_API
pc_status pc_model_set_dissipation(pc_model *model,
                                   const char *expression,
                                   pc_error **error);

/**
 * Adds a force that is conjugate to a quasi-velocity or to a coordinate.
 */
PC_API
pc_status pc_model_add_force(pc_model *model,
                             const char *on,
                             const char *expression,
                             pc_error **error);

/**
 * Adds an integral: an expression that should stay constant, observed along the motion.
 */
PC_API
pc_status pc_model_add_integral(pc_model *model,
                                const char *name,
                                const char *expression,
                                pc_error **error);

/**
 * Adds an output: an expression observed along the motion.
 */
PC_API
pc_status pc_model_add_output(pc_model *model,
                              const char *name,
                              const char *expression,
                              pc_error **error);

/**
 * Adds an input: a value that is constant until it is set, in the same way as a parameter. Inputs
 * come after all parameters. Forces, rates of states, events, integrals and outputs may contain
 * it; velocities, momenta, constraints and positions of bodies may not.
 */
PC_API
pc_status pc_model_add_input(pc_model *model,
                             const char *name,
                             double value,
                             pc_error **error);

/**
 * Adds an input that is a function of time: `length` values at increasing times, interpolated
 * by "linear", "cubic" or "hold"; NULL for "linear". No step of a solver crosses one of the times.
 * The values of the input come from the table alone.
 */
PC_API
pc_status pc_model_add_input_table(pc_model *model,
                                   const char *name,
                                   const double *times,
                                   const double *values,
                                   size_t length,
                                   const char *interpolation,
                                   pc_error **error);

/**
 * Adds an input that is a smooth function of time: `length` values with their rates, and perhaps
 * accelerations, at increasing times. Between these it is a polynomial of degree 3 that has the
 * values and rates at both ends, or of degree 5 with the accelerations too; NULL for accelerations
 * that are not given. Unlike other inputs it may appear in velocities, momenta, constraints and
 * positions of bodies. The inputs u' and u'' that follow it in the list of inputs are its rates.
 */
PC_API
pc_status pc_model_add_input_curve(pc_model *model,
                                   const char *name,
                                   const double *times,
                                   const double *values,
                                   const double *rates,
                                   const double *accelerations,
                                   size_t length,
                                   pc_error **error);

/**
 * Adds an input whose table is a column of a file of comma-separated numbers, the first line of
 * which holds the names of the columns; otherwise this is like pc_model_add_input_table. `time` is
 * the name of the column of times, NULL for "t" or, if there is no such column, for the first one.
 * The path is relative to the working directory at the time of the call.
 */
PC_API
pc_status pc_model_add_input_file(pc_model *model,
                                  const char *name,
                                  const char *path,
                                  const char *column,
                                  const char *time,
                                  const char *interpolation,
                                  pc_error **error);

/**
 * Adds an input as pc_model_add_input_curve does, from the columns of a file: of values, of rates,
 * of accelerations, NULL where these are not given, and of times, as in pc_model_add_input_file.
 */
PC_API
pc_status pc_model_add_input_curve_file(pc_model *model,
                                        const char *name,
                                        const char *path,
                                        const char *column,
                                        const char *rate,
                                        const char *acceleration,
                                        const char *time,
                                        pc_error **error);

/**
 * Adds a particle, or a rigid body if it is given an inertia. The mass, and the position of the
 * mass centre or of a point of the body that is at rest, are expressions in the coordinates.
 * Energy and forces follow from the bodies, so the model needs no Lagrangian.
 */
PC_API
pc_status pc_model_add_body(pc_model *model,
                            const char *name,
                            const char *mass,
                            const char *x,
                            const char *y,
                            const char *z,
                            pc_error **error);

/**
 * Sets the force on a body, which acts at the position of the body, in axes fixed in space.
 */
PC_API
pc_status pc_model_set_body_force(pc_model *model,
                                  const char *body,
                                  const char *x,
                                  const char *y,
                                  const char *z,
                                  pc_error **error);

/**
 * Sets the torque on a rigid body, in the axes in which its angular velocity is given.
 */
PC_API
pc_status pc_model_set_body_torque(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the angular velocity of a rigid body, in axes of the body. It cannot be combined with
 * pc_model_set_body_rotation.
 */
PC_API
pc_status pc_model_set_body_angular_velocity(pc_model *model,
                                             const char *body,
                                             const char *x,
                                             const char *y,
                                             const char *z,
                                             pc_error **error);

/**
 * Sets the inertia of a rigid body about its position, in axes of the body: 3 expressions
 * Ixx, Iyy, Izz, or 6, which continue with Ixy, Iyz, Ixz.
 */
PC_API
pc_status pc_model_set_body_inertia(pc_model *model,
                                    const char *body,
                                    const char *const *entries,
                                    size_t length,
                                    pc_error **error);

/**
 * Sets the rotation of a rigid body: the 9 entries of the matrix R from axes of the body to
 * axes fixed in space, row by row.
 */
PC_API
pc_status pc_model_set_body_rotation(pc_model *model,
                                     const char *body,
                                     const char *const *entries,
                                     size_t length,
                                     pc_error **error);

/**
 * Adds a body that is attached to another, or to the world if `parent` is null, by a joint of this
 * kind: fixed, revolute, prismatic, screw, cylindrical, universal, planar, spherical, free. The
 * origin of the body is the point of the joint. Inertia, force and torque are set as for other
 * bodies, start values by pc_model_add_coordinate and pc_model_add_quasi_velocity with the names
 * that the joint gives, such as `NAME` and `NAME'` for a revolute one.
 */
PC_API
pc_status pc_model_add_jointed_body(pc_model *model,
                                    const char *name,
                                    const char *parent,
                                    const char *kind,
                                    pc_error **error);

/**
 * Sets the mass of a body that is attached by a joint.
 */
PC_API
pc_status pc_model_set_body_mass(pc_model *model,
                                 const char *body,
                                 const char *mass,
                                 pc_error **error);

/**
 * Sets the mass centre of a body that is attached by a joint, in axes of the body and relative to
 * its origin.
 */
PC_API
pc_status pc_model_set_body_center(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the point of a joint, in axes of the parent and relative to its origin.
 */
PC_API
pc_status pc_model_set_joint_place(pc_model *model,
                                   const char *body,
                                   const char *x,
                                   const char *y,
                                   const char *z,
                                   pc_error **error);

/**
 * Sets the axis of a joint, in axes of the joint; `axis` has 3 numbers, of any length but 0.
 */
PC_API
pc_status pc_model_set_joint_axis(pc_model *model,
                                  const char *body,
                                  const double *axis,
                                  pc_error **error);

/**
 * Sets the two axes of a universal joint, of 3 numbers each: the first is fixed in the parent,
 * the second in the body.
 */
PC_API
pc_status pc_model_set_joint_axes(pc_model *model,
                                  const char *body,
                                  const double *first,
                                  const double *second,
                                  pc_error **error);

/**
 * Sets the pitch of a screw joint, a length per radian.
 */
PC_API
pc_status pc_model_set_joint_pitch(pc_model *model,
                                   const char *body,
                                   const char *pitch,
                                   pc_error **error);

/**
 * Gears a joint with one coordinate to that of the body `followed`: its coordinate is `ratio`
 * times the other's plus `offset`; null stands for 1 and for 0. It has no quasi-velocity of its
 * own; the name of its coordinate is that of a definition and of an output.
 */
PC_API
pc_status pc_model_set_joint_gear(pc_model *model,
                                  const char *body,
                                  const char *followed,
                                  const char *ratio,
                                  const char *offset,
                                  pc_error **error);

/**
 * Sets the armature J of a joint with one coordinate x, which adds J x'^2/2 to the kinetic energy:
 * the inertia of a rotor times the square of the gear's ratio.
 */
PC_API
pc_status pc_model_set_joint_armature(pc_model *model,
                                      const char *body,
                                      const char *armature,
                                      pc_error **error);

/**
 * Adds a spring to a joint with one coordinate x, with the potential energy
 * stiffness (x - rest)^2/2; a null `rest` stands for 0.
 */
PC_API
pc_status pc_model_set_joint_spring(pc_model *model,
                                    const char *body,
                                    const char *stiffness,
                                    const char *rest,
                                    pc_error **error);

/**
 * Sets the damping d of a joint with one coordinate x: the force -d x'.
 */
PC_API
pc_status pc_model_set_joint_damping(pc_model *model,
                                     const char *body,
                                     const char *damping,
                                     pc_error **error);

/**
 * Sets the dry friction F of a joint with one coordinate x: the force -F sign(x'), and any force
 * up to F where the joint is at rest.
 */
PC_API
pc_status pc_model_set_joint_friction(pc_model *model,
                                      const char *body,
                                      const char *friction,
                                      pc_error **error);

/**
 * Sets stops at the ends of the way of a joint with one coordinate: beyond an end by s, they push
 * back with stiffness s + damping s'; a null `damping` stands for 0.
 */
PC_API
pc_status pc_model_set_joint_limits(pc_model *model,
                                    const char *body,
                                    const char *lower,
                                    const char *upper,
                                    const char *stiffness,
                                    const char *damping,
                                    pc_error **error);

/**
 * Sets rigid stops at the ends of the way of a joint with one coordinate x: there x' becomes
 * -restitution x', and all velocities change by the impulse along the joint. A joint that is
 * pushed against a stop comes to rest there. It cannot be combined with
 * pc_model_set_joint_limits.
 */
PC_API
pc_status pc_model_set_joint_restitution(pc_model *model,
                                         const char *body,
                                         const char *lower,
                                         const char *upper,
                                         const char *restitution,
                                         pc_error **error);

/**
 * Sets the stiction of a joint with friction: at rest, friction holds it up to this force, which
 * is at least that of pc_model_set_joint_friction.
 */
PC_API
pc_status pc_model_set_joint_stiction(pc_model *model,
                                      const char *body,
                                      const char *stiction,
                                      pc_error **error);

/**
 * Sets the rotation from the axes of a joint to those of the parent: the 9 entries of its
 * matrix, row by row. It cannot be combined with pc_model_set_joint_turns.
 */
PC_API
pc_status pc_model_set_joint_rotation(pc_model *model,
                                      const char *body,
                                      const char *const *entries,
                                      size_t length,
                                      pc_error **error);

/**
 * Sets the rotation of pc_model_set_joint_rotation as a sequence of turns about axes: `axes` has a
 * letter x, y or z for each of the `length` angles; each turn is about an axis as moved by the
 * turns before it.
 */
PC_API
pc_status pc_model_set_joint_turns(pc_model *model,
                                   const char *body,
                                   const char *axes,
                                   const char *const *angles,
                                   size_t length,
                                   pc_error **error);

/**
 * Sets names for the coordinates of a joint, in place of the default names of its kind.
 */
PC_API
pc_status pc_model_name_joint_coordinates(pc_model *model,
                                          const char *body,
                                          const char *const *names,
                                          size_t length,
                                          pc_error **error);

/**
 * Sets names for the quasi-velocities of a joint, in place of the default names of its kind.
 */
PC_API
pc_status pc_model_name_joint_quasi_velocities(pc_model *model,
                                               const char *body,
                                               const char *const *names,
                                               size_t length,
                                               pc_error **error);

/**
 * Adds a point of a body that is attached by a joint, in axes of the body and relative to its
 * origin. In expressions its coordinates are `NAME_x`, `NAME_y`, `NAME_z`.
 */
PC_API
pc_status pc_model_add_point(pc_model *model,
                             const char *name,
                             const char *body,
                             const char *x,
                             const char *y,
                             const char *z,
                             pc_error **error);

/**
 * Closes a loop by joining two bodies that are attached by joints; the kind is point, revolute or
 * rod. `places` has 6 expressions: the point of the first body in its axes, then that of the
 * second.
 */
PC_API
pc_status pc_model_add_loop(pc_model *model,
                            const char *name,
                            const char *kind,
                            const char *first,
                            const char *second,
                            const char *const *places,
                            pc_error **error);

/**
 * Sets the axis of a revolute loop, in axes of the first body and in those of the second, with 3
 * numbers each.
 */
PC_API
pc_status pc_model_set_loop_axes(pc_model *model,
                                 const char *name,
                                 const double *first,
                                 const double *second,
                                 pc_error **error);

/**
 * Sets the distance between the two points of a rod.
 */
PC_API
pc_status pc_model_set_loop_length(pc_model *model,
                                   const char *name,
                                   const char *length,
                                   pc_error **error);

/**
 * Adds a contact of a body with a plane or uneven ground. The shape is disc, sphere or ellipsoid,
 * and the motion rolls or slides. pc_model_set_contact sets the size of the shape, and what else
 * the text may say.
 */
PC_API
pc_status pc_model_add_contact(pc_model *model,
                               const char *name,
                               const char *body,
                               const char *shape,
                               const char *motion,
                               pc_error **error);

/**
 * Sets an entry of a contact: radius or height, with 1 value; axis, semi_axes, at, normal or
 * through, with 3; attitude, with 9; keeps, with the value true. The values are expressions,
 * those of an axis numbers.
 */
PC_API
pc_status pc_model_set_contact(pc_model *model,
                               const char *name,
                               const char *entry,
                               const char *const *values,
                               size_t length,
                               pc_error **error);

/**
 * Sets a function S of time, coordinates and constants that is claimed to solve
 * Hamilton–Jacobi's equation; pc_system_theory examines the claim, and compares the motion from
 * the start with the one that Jacobi's theorem gives. Motions do not depend on this function.
 */
PC_API pc_status pc_model_set_action(pc_model *model, const char *expression, pc_error **error);

/**
 * Adds a constant of the action, with a value near which the action is defined: if no proof is
 * found that the action solves the equation, the claim is tested numerically near these values.
 */
PC_API
pc_status pc_model_add_action_constant(pc_model *model,
                                       const char *name,
                                       double value,
                                       pc_error **error);

/**
 * Sets the description of the model.
 */
PC_API
pc_status pc_model_set_description(pc_model *model,
                                   const char *description,
                                   pc_error **error);

/**
 * Sets the reference to the source of the model.
 */
PC_API pc_status pc_model_set_reference(pc_model *model, const char *reference, pc_error **error);

/**
 * Changes the start value of a coordinate, of a quasi-velocity, or of a velocity `x'` where
 * there are no quasi-velocities, to a number.
 */
PC_API
pc_status pc_model_set_start(pc_model *model,
                             const char *name,
                             double value,
                             pc_error **error);

/**
 * Changes a start value to an expression in parameters; otherwise this is like pc_model_set_start.
 */
PC_API
pc_status pc_model_set_start_expression(pc_model *model,
                                        const char *name,
                                        const char *expression,
                                        pc_error **error);

/**
 * Sets the kind of a constraint: "holonomic" or "nonholonomic", which is checked, or
 * "nonlinear" for one that is not affine in the velocities and obeys Chetaev's condition.
 */
PC_API
pc_status pc_model_set_constraint_kind(pc_model *model,
                                       const char *constraint,
                                       const char *kind,
                                       pc_error **error);

/**
 * Sets the time at the start; 0 unless set.
 */
PC_API pc_status pc_model_set_start_time(pc_model *model, double t, pc_error **error);

/**
 * Sets the time until which the program `pc` runs the model. This time is written to the text, as
 * are the settings of the next five functions; solvers take pc_solver_options instead.
 */
PC_API pc_status pc_model_set_end_time(pc_model *model, double t, pc_error **error);

/**
 * Sets the number of rows, at least 2, that the program `pc` writes.
 */
PC_API pc_status pc_model_set_samples(pc_model *model, size_t samples, pc_error **error);

/**
 * Sets the tolerances with which the program `pc` runs the model, both positive.
 */
PC_API
pc_status pc_model_set_tolerances(pc_model *model,
                                  double relative,
                                  double absolute,
                                  pc_error **error);

/**
 * Sets the largest length of a step, positive, with which the program `pc` runs the model: an
 * event whose function passes through zero and back within a step is missed.
 */
PC_API pc_status pc_model_set_max_step(pc_model *model, double length, pc_error **error);

/**
 * Sets how the program `pc` looks for zeros of event functions: at `samples_per_step` points in
 * each step, at least 1; events whose intervals shrink until the time left is less than
 * `accumulation` of the first interval count as accumulated.
 */
PC_API
pc_status pc_model_set_event_search(pc_model *model,
                                    size_t samples_per_step,
                                    double accumulation,
                                    pc_error **error);

/**
 * Sets the method by which the program `pc` runs the model: "auto", "adams", "bdf", "dop853" or
 * "taylor".
 */
PC_API pc_status pc_model_set_method(pc_model *model, const char *method, pc_error **error);

/**
 * Sets the form of the equations that the program `pc` integrates: "poincare", "canonical".
 */
PC_API pc_status pc_model_set_form(pc_model *model, const char *form, pc_error **error);

/**
 * Makes a handle that can end derivations and integrations.
 */
PC_API pc_status pc_cancel_new(pc_cancel **cancel, pc_error **error);

/**
 * Ends derivations and integrations with PC_LIMIT: those under way end soon, and later ones as
 * soon as they begin. It takes no lock and allocates nothing: it is the one function that a signal
 * handler may call. NULL is allowed.
 */
PC_API void pc_cancel_request(const pc_cancel *cancel);

/**
 * Returns 1 after pc_cancel_request, else 0; 0 for NULL.
 */
PC_API int pc_cancel_is_requested(const pc_cancel *cancel);

/**
 * Frees a handle; systems whose options contain it continue without it. NULL is allowed.
 */
PC_API void pc_cancel_free(pc_cancel *cancel);

/**
 * Sets the options to their defaults. `size` is sizeof(pc_system_options). NULL is allowed.
 */
PC_API void pc_system_options_init(pc_system_options *options, size_t size);

/**
 * Sets the options to their defaults. `size` is sizeof(pc_solver_options). NULL is allowed.
 */
PC_API void pc_solver_options_init(pc_solver_options *options, size_t size);

/**
 * Derives and compiles the equations of a model, as pc_system_new does, for any number of systems
 * made by pc_system_of_code. `options` may be NULL.
 */
PC_API
pc_status pc_code_new(const pc_model *model,
                      const pc_system_options *options,
                      pc_code **code,
                      pc_error **error);

/**
 * Frees a code. NULL is allowed. Its systems stay as they are.
 */
PC_API void pc_code_free(pc_code *code);

/**
 * Makes a system of a code, with the parameters of the model: the data of one thread. Nothing is
 * derived. Systems of one code share its equations and their machine code, whichever of them needs
 * it first, and everything that is derived on first use; threads that use a system each never wait
 * for one another, except for such a derivation. Any number of threads may make systems of one
 * code at the same time.
 */
PC_API pc_status pc_system_of_code(const pc_code *code, pc_system **system, pc_error **error);

/**
 * Writes a code as bytes, to be freed with pc_bytes_free and read by pc_code_load, possibly in
 * another run of the program. They contain the text of the model, its equations, and what has been
 * derived on first use so far (such as mass matrices and Jacobians of bodies), but no machine
 * code: the bytes are the same on every machine. Tables that the model read from files are among
 * them.
 */
PC_API pc_status pc_code_save(const pc_code *code, void **data, size_t *length, pc_error **error);

/**
 * Reads a code that pc_code_save has written; nothing is derived. Returns PC_INVALID_CODE unless
 * the bytes are exactly what a library of this layout has written, judged by the hash that they
 * contain. The hash shows damage, not intent: load no bytes that a stranger may have written.
 * There are no limits on what is derived from this code later.
 */
PC_API pc_status pc_code_load(const void *data, size_t length, pc_code **code, pc_error **error);

/**
 * Derives and compiles the equations of a model. `options` may be NULL. This takes from
 * milliseconds to seconds (the latter for a hundred bodies); other functions are fast unless they
 * say that they derive.
 */
PC_API
pc_status pc_system_new(const pc_model *model,
                        const pc_system_options *options,
                        pc_system **system,
                        pc_error **error);

/**
 * Makes a copy for another thread, with the current parameters. It shares the machine code that
 * exists: that of f, and that of each derivative that the original has evaluated before (the first
 * evaluation of a derivative compiles it).
 */
PC_API pc_status pc_system_clone(const pc_system *system, pc_system **copy, pc_error **error);

/**
 * Frees a system. NULL is allowed. It does nothing when called from a function of your program
 * that a call on this system runs.
 */
PC_API void pc_system_free(pc_system *system);

/**
 * The length of the state y: coordinates, quasi-velocities or momenta, first-order states; 0
 * for NULL.
 */
PC_API size_t pc_system_dim(const pc_system *system);

/**
 * The number of coordinates, which come first in the state; 0 for NULL.
 */
PC_API size_t pc_system_coordinate_count(const pc_system *system);

/**
 * The number of first-order states, which come last in the state; 0 for NULL.
 */
PC_API size_t pc_system_state_count(const pc_system *system);

/**
 * The number of parameters; 0 for NULL.
 */
PC_API size_t pc_system_parameter_count(const pc_system *system);

/**
 * The number of observables: the integrals, "energy", the outputs; 0 for NULL.
 */
PC_API size_t pc_system_observable_count(const pc_system *system);

/**
 * The number of observables that should stay constant: the integrals and the energy, which come
 * first; 0 for NULL.
 */
PC_API size_t pc_system_conserved_count(const pc_system *system);

/**
 * The number of constraints that projection maintains; 0 for NULL.
 */
PC_API size_t pc_system_constraint_count(const pc_system *system);

/**
 * The number of reactions; 0 without pc_model_observe_reactions, and for NULL.
 */
PC_API size_t pc_system_reaction_count(const pc_system *system);

/**
 * The name of a component of the state, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_system_name(const pc_system *system, size_t index);

/**
 * The name of a parameter, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_system_parameter_name(const pc_system *system, size_t index);

/**
 * The name of an observable, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_system_observable_name(const pc_system *system, size_t index);

/**
 * The name of a constraint that projection maintains, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_system_constraint_name(const pc_system *system, size_t index);

/**
 * The name of a reaction, `λ_` followed by the name of its constraint, counted from 0; NULL beyond
 * the last.
 */
PC_API
const char *pc_system_reaction_name(const pc_system *system,
                                    size_t index);

/**
 * Writes the time and state from which the model starts. `t` may be NULL.
 */
PC_API
pc_status pc_system_start(const pc_system *system,
                          double *t,
                          double *y,
                          size_t y_length,
                          pc_error **error);

/**
 * Writes the absolute tolerance of each component of the state with which the program `pc` would
 * run the system from its start to t_end: the tolerance in the text if it gives one, else
 * min(1e-12, relative·s) for a component of scale s at the start, where f is evaluated once, but
 * no less than the rounding error of the largest component. pc_solver_options takes them as
 * absolute_tolerances.
 */
PC_API
pc_status pc_system_absolute_tolerances(const pc_system *system,
                                        double relative,
                                        double t_end,
                                        double *values,
                                        size_t length,
                                        pc_error **error);

/**
 * Writes the values of all parameters. Where a parameter that is an expression in others has no
 * value, its entry is not a finite number.
 */
PC_API
pc_status pc_system_parameters(const pc_system *system,
                               double *values,
                               size_t length,
                               pc_error **error);

/**
 * Sets all parameters, which is cheap, since nothing is derived again. The start stays the same,
 * and solvers and kernels made before keep the values they have. Inputs come after the parameters;
 * an input with a table follows its table whatever it is set to.
 */
PC_API
pc_status pc_system_set_parameters(pc_system *system,
                                   const double *values,
                                   size_t length,
                                   pc_error **error);

/**
 * Sets one parameter, by its index; parameters that are expressions in it change with it, unless
 * they have themselves been set. Otherwise this is like pc_system_set_parameters.
 */
PC_API
pc_status pc_system_set_parameter(pc_system *system,
                                  size_t index,
                                  double value,
                                  pc_error **error);

/**
 * Writes the index of a component of the state, counted from 0, by its name. Returns PC_NOT_FOUND
 * if no component has this name.
 */
PC_API
pc_status pc_system_find(const pc_system *system,
                         const char *name,
                         size_t *index,
                         pc_error **error);

/**
 * Writes the index of a parameter or input, counted from 0, by its name, as pc_system_find does.
 */
PC_API
pc_status pc_system_find_parameter(const pc_system *system,
                                   const char *name,
                                   size_t *index,
                                   pc_error **error);

/**
 * Writes the index of an observable, counted from 0, by its name, as pc_system_find does.
 */
PC_API
pc_status pc_system_find_observable(const pc_system *system,
                                    const char *name,
                                    size_t *index,
                                    pc_error **error);

/**
 * Declares that a force computed by a function of yours acts on a quasi-velocity or, if the model
 * declares no quasi-velocities, on the velocity x' of a coordinate x; "x" means the same. This
 * force is added to the other forces that act there. The function belongs to the system, not to
 * the model: set it with pc_system_set_force. An unknown name is reported by pc_model_check and
 * pc_system_new.
 */
PC_API pc_status pc_model_add_external_force(pc_model *model, const char *on, pc_error **error);

/**
 * The number of external forces; 0 for NULL.
 */
PC_API size_t pc_system_force_count(const pc_system *system);

/**
 * The name of the quasi-velocity on which an external force acts, counted from 0; NULL beyond the
 * last.
 */
PC_API const char *pc_system_force_name(const pc_system *system, size_t index);

/**
 * Sets the function that computes the external forces, all at once: the Q_s of the declared
 * quasi-velocities. Until it is set, nothing that needs these forces can be evaluated. `jacobian`
 * may be NULL: the derivatives of the forces, and only these, are then computed as difference
 * quotients.
 *
 * Copies, kernels and solvers made from the system afterwards share the functions and `user`;
 * those made before keep the functions they had. The functions are called on whichever thread
 * evaluates; if several threads use copies, several calls may run at the same time. They may call
 * any function on other handles, and on the same system those that return names
 * (pc_system_..._name) and sizes.
 *
 * `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else
 * when the last handle that shares it is freed or given another function. `destroy` must not use a
 * handle that is being freed.
 */
PC_API
pc_status pc_system_set_force(pc_system *system,
                              pc_force_function function,
                              pc_force_jacobian jacobian,
                              void *user,
                              pc_destroy destroy,
                              pc_error **error);

/**
 * Adds a quasi-velocity to those of the model, for systems of the form PC_HAMEL: a linear
 * form in the velocities x' or the quasi-velocities of the model, such as "r*f'". Where fewer are
 * given than there are independent quasi-velocities, the missing ones are taken from those of the
 * model. Each added quasi-velocity is also an output. Errors in its definition are reported by
 * pc_model_check and pc_system_new.
 */
PC_API
pc_status pc_model_give_quasi_velocity(pc_model *model,
                                       const char *name,
                                       const char *definition,
                                       pc_error **error);

/**
 * Chooses a velocity as independent; there must be as many choices as there are velocities that
 * the constraints leave free. Systems whose equations would otherwise contain multipliers then
 * have equations without them. The name is that of a quasi-velocity, or x' where there are none.
 * Without such choices, printed equations and source use the velocities that make them shortest. A
 * wrong choice is reported by pc_system_new.
 */
PC_API pc_status pc_model_add_independent(pc_model *model, const char *name, pc_error **error);

/**
 * Writes the rate f(t, y) of the state to ydot.
 *
 * After the first call it takes no lock if f is a single piece of machine code, that is, if no
 * function of the program computes forces, M is not factorised numerically, and no velocities are
 * solved for. Any number of threads may then call it at the same time; while another thread sets
 * parameters, the rates are those for the parameters before or after. It returns PC_BUSY, with
 * ydot undefined, only if parameters are set during its evaluation, or if it fails while the
 * handle is in use.
 */
PC_API
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
PC_API
pc_status pc_system_jacobian(const pc_system *system,
                             double t,
                             const double *y,
                             size_t y_length,
                             double *jacobian,
                             size_t length,
                             pc_error **error);

/**
 * The entries of ∂f/∂y that may be nonzero, in compressed columns: the rows of the entries of
 * column j, ascending, are `row_indices[column_starts[j]]` up to, but not including,
 * `row_indices[column_starts[j + 1]]`. Gives pointers to dim + 1 and `entries` numbers that
 * belong to the system and its copies. Each of the three arguments may be NULL.
 */
PC_API
pc_status pc_system_jacobian_pattern(const pc_system *system,
                                     size_t *entries,
                                     const size_t **column_starts,
                                     const size_t **row_indices,
                                     pc_error **error);

/**
 * Writes the entries of ∂f/∂y that pc_system_jacobian_pattern lists, in its order.
 */
PC_API
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
PC_API
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
 * Writes ∂f/∂p, dim × pc_system_parameter_count and column-major, so `length` is their product.
 * Each derivative is taken with all other parameters fixed, even those that are expressions in
 * this one; for an input with a table, the derivative is taken with respect to the value of the
 * input. Returns PC_UNSUPPORTED if pc_model_differentiate was not called, or if there are external
 * forces.
 */
PC_API
pc_status pc_system_parameter_jacobian(const pc_system *system,
                                       double t,
                                       const double *y,
                                       size_t y_length,
                                       double *jacobian,
                                       size_t length,
                                       pc_error **error);

/**
 * Writes ∂f/∂t, which Rosenbrock's methods need; it has the length of the state. The first call
 * derives it, as pc_system_new derives equations, unless f does not contain t. Returns
 * PC_UNSUPPORTED if there are external forces, whose ∂/∂t is unknown, or inputs that have tables.
 */
PC_API
pc_status pc_system_time_derivative(const pc_system *system,
                                    double t,
                                    const double *y,
                                    size_t y_length,
                                    double *derivative,
                                    size_t length,
                                    pc_error **error);

/**
 * Projects the state, in place: onto the constraints, along the shortest path in the kinetic
 * metric, and to the values that the integrals of pc_model_keep have at the start of the model, or
 * at the state of pc_system_keep_from. With neither constraints nor such integrals the state stays
 * as it is.
 */
PC_API
pc_status pc_system_project(const pc_system *system,
                            double t,
                            double *y,
                            size_t y_length,
                            pc_error **error);

/**
 * Makes pc_system_project keep the integrals of pc_model_keep at their values at (t, y),
 * moved onto the constraints, also after parameters are set. Solvers maintain the values at their
 * own start.
 */
PC_API
pc_status pc_system_keep_from(pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              pc_error **error);

/**
 * Writes the observables at (t, y), as many as pc_system_observable_count: the integrals, the
 * energy, the outputs.
 *
 * Where an observable has no value, its entry is not a finite number; the same holds for an
 * observable that contains accelerations where external forces cannot be computed.
 */
PC_API
pc_status pc_system_observe(const pc_system *system,
                            double t,
                            const double *y,
                            size_t y_length,
                            double *values,
                            size_t length,
                            pc_error **error);

/**
 * Writes the integrals and the energy at (t, y), as many as pc_system_conserved_count: these are
 * the first of the observables, and should stay constant.
 */
PC_API
pc_status pc_system_integrals(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              double *values,
                              size_t length,
                              pc_error **error);

/**
 * Writes the energy y_s η_s − L at (t, y). No function that computes external forces is called.
 */
PC_API
pc_status pc_system_energy(const pc_system *system,
                           double t,
                           const double *y,
                           size_t y_length,
                           double *energy,
                           pc_error **error);

/**
 * Writes the reactions of the constraints at (t, y), as many as pc_system_reaction_count: each
 * adds its value times the derivative of its constraint with respect to η_s to the force Q_s.
 */
PC_API
pc_status pc_system_reactions(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              double *values,
                              size_t length,
                              pc_error **error);

/**
 * Writes the residual of each constraint that projection maintains, as many as
 * pc_system_constraint_count.
 */
PC_API
pc_status pc_system_constraint_residuals(const pc_system *system,
                                         double t,
                                         const double *y,
                                         size_t y_length,
                                         double *values,
                                         size_t length,
                                         pc_error **error);

/**
 * Adds an event, which occurs where the expression `when` passes through zero in the given
 * direction, a pc_direction. If `terminal` is not 0, the event ends an integration with PC_EVENT.
 * Simultaneous events are handled in the order in which they were added.
 */
PC_API
pc_status pc_model_add_event(pc_model *model,
                             const char *name,
                             const char *when,
                             int direction,
                             int terminal,
                             pc_error **error);

/**
 * Adds a reset to an event: where the event occurs, the coordinate, quasi-velocity or
 * velocity `x'` called `variable` takes the value of the expression. All resets of an event take
 * effect together and use the state before the event.
 */
PC_API
pc_status pc_model_add_event_reset(pc_model *model,
                                   const char *event,
                                   const char *variable,
                                   const char *expression,
                                   pc_error **error);

/**
 * The number of events of the model; 0 for NULL.
 */
PC_API size_t pc_system_event_count(const pc_system *system);

/**
 * The name of an event, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_system_event_name(const pc_system *system, size_t index);

/**
 * The direction of an event, a pc_direction; PC_BOTH beyond the last. These are the numbers that
 * CVODE's CVodeSetRootDirection takes.
 */
PC_API int pc_system_event_direction(const pc_system *system, size_t index);

/**
 * Returns 1 if an event ends the integration, else 0.
 */
PC_API int pc_system_event_is_terminal(const pc_system *system, size_t index);

/**
 * Returns 1 if an event resets the state, else 0.
 */
PC_API int pc_system_event_resets(const pc_system *system, size_t index);

/**
 * Writes the functions of the events at (t, y), as many as pc_system_event_count: an event
 * occurs where its function passes through zero. Where a function has no value, its entry is not a
 * finite number.
 */
PC_API
pc_status pc_system_events(const pc_system *system,
                           double t,
                           const double *y,
                           size_t y_length,
                           double *values,
                           size_t length,
                           pc_error **error);

/**
 * Turns the state y before an event, number `event` counted from 0, into the state after it. An
 * event without resets leaves y unchanged.
 */
PC_API
pc_status pc_system_event_reset(const pc_system *system,
                                size_t event,
                                double t,
                                double *y,
                                size_t y_length,
                                pc_error **error);

/**
 * Writes the mass matrix M = ∂²L/∂η∂η at (t, y), k × k for the k quasi-velocities of the state,
 * so `length` is k*k; k is pc_system_dim less pc_system_coordinate_count and
 * pc_system_state_count. Rows for multipliers are not part of M. The first call derives M, as
 * pc_system_new derives equations.
 */
PC_API
pc_status pc_system_mass_matrix(const pc_system *system,
                                double t,
                                const double *y,
                                size_t y_length,
                                double *matrix,
                                size_t length,
                                pc_error **error);

/**
 * Writes the right-hand side r of M η̇ = r at (t, y), k numbers, with k and M as in
 * pc_system_mass_matrix: all forces and gyroscopic terms, without the reactions that multipliers
 * represent. The first call derives r, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_right_hand_side(const pc_system *system,
                                    double t,
                                    const double *y,
                                    size_t y_length,
                                    double *right,
                                    size_t length,
                                    pc_error **error);

/**
 * Writes the generalised forces tau = M η̇ + h - Q that have to be added to the forces Q of the
 * model for the accelerations η̇ at (t, y): inverse dynamics. Both lists have k numbers, with k
 * as in pc_system_mass_matrix; null accelerations stand for zeros, so that tau is what the motion
 * itself requires, and in a state at rest what holds the system there. The forces of constraints
 * that multipliers hold are part of tau. For bodies on joints tau is found from body to body. The
 * first call derives equations, as pc_system_new does.
 */
PC_API
pc_status pc_system_inverse_dynamics(const pc_system *system,
                                     double t,
                                     const double *y,
                                     size_t y_length,
                                     const double *accelerations,
                                     size_t accelerations_length,
                                     double *tau,
                                     size_t tau_length,
                                     pc_error **error);

/**
 * Solves M w = v at (t, y), with M as in pc_system_mass_matrix, and writes w = M⁻¹ v; both have k
 * numbers. The first call derives M, as pc_system_new derives equations. Returns PC_EVALUATION
 * where M is singular.
 */
PC_API
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
 * Writes the number K of operators X_1 … X_K that have structure coefficients: one for each
 * quasi-velocity of the state, then one for each quasi-velocity that constraints make vanish. The
 * first call derives them, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_operator_count(const pc_system *system,
                                   size_t *operators,
                                   pc_error **error);

/**
 * Writes the structure coefficients of [X_r, X_s] = c_rs^m X_m, (5), at (t, y), for r, s = 0 …
 * K, with 0 for time, and m = 1 … K: c[(r*(K + 1) + s)*K + m - 1], so `length` is (K + 1)*(K +
 * 1)*K. The first call derives them, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_structure_coefficients(const pc_system *system,
                                           double t,
                                           const double *y,
                                           size_t y_length,
                                           double *c,
                                           size_t length,
                                           pc_error **error);

/**
 * Writes the residual of the equations for ydot in the form expected by codes for implicit
 * equations F(t, y, ẏ) = 0: ẋ − b η − b_0, then M η̇ − r, without dividing by M. If there are
 * multipliers, whose reactions are eliminated, the second part is M times the error of η̇; in the
 * canonical form the residual is ẏ − f. The first call derives equations, as pc_system_new does.
 */
PC_API
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
 * Writes the Coriolis matrix C at (t, y), k × k and column-major, with k as in
 * pc_system_mass_matrix: C η are the terms of M η̇ + h = Q that are quadratic in η,
 *
 *   C_sm = ½ (X_r M_sm + X_m M_sr − X_s M_rm + c_rm^l M_ls − c_rs^l M_lm − c_ms^l M_lr) η_r,
 *
 * with Christoffel's symbols where the c_rs^m vanish. dM/dt − 2C is skew-symmetric where neither
 * M nor the frame depends on t; otherwise C + Cᵀ is the part of dM/dt that is linear in η. The
 * first call derives C, as pc_system_new derives equations. Returns PC_INCONSISTENT_MODEL where M
 * depends on η.
 */
PC_API
pc_status pc_system_coriolis(const pc_system *system,
                             double t,
                             const double *y,
                             size_t y_length,
                             double *matrix,
                             size_t length,
                             pc_error **error);

/**
 * Writes the centroidal momentum matrix A at (t, y), column-major, with two more columns a and r:
 * 6 × (k + 2), with k as in pc_system_mass_matrix. The momentum P of all bodies and their angular
 * momentum L about their common mass centre, along fixed axes, are (P, L) = A η + a; a = 0 where
 * nothing depends on t. Their rates are A η̇ + r. The first call derives them, as pc_system_new
 * derives equations. Returns PC_UNSUPPORTED for a model without bodies, and PC_INVALID_MODEL for a
 * body whose angular velocity is given without a rotation.
 */
PC_API
pc_status pc_system_centroidal(const pc_system *system,
                               double t,
                               const double *y,
                               size_t y_length,
                               double *matrix,
                               size_t length,
                               pc_error **error);

/**
 * Writes the common mass centre of all bodies at (t, y), 3 numbers along fixed axes. The first
 * call derives it, as pc_system_new derives equations. Returns PC_UNSUPPORTED for a model without
 * bodies.
 */
PC_API
pc_status pc_system_centre_of_mass(const pc_system *system,
                                   double t,
                                   const double *y,
                                   size_t y_length,
                                   double *centre,
                                   size_t length,
                                   pc_error **error);

/**
 * Writes the Jacobian J of the common mass centre of all bodies at (t, y), column-major, with two
 * more columns a and r: 3 × (k + 2), with k as in pc_system_mass_matrix. Its velocity along fixed
 * axes is J η + a, and its acceleration J η̇ + r. Otherwise like pc_system_centre_of_mass.
 */
PC_API
pc_status pc_system_centre_of_mass_jacobian(const pc_system *system,
                                            double t,
                                            const double *y,
                                            size_t y_length,
                                            double *jacobian,
                                            size_t length,
                                            pc_error **error);

/**
 * Writes the Jacobian J of a point of a body at (t, y), column-major, with two more columns a and
 * r: 6 × (k + 2), with k as in pc_system_mass_matrix. The velocity v of the point and the angular
 * velocity ω of the body, along fixed axes, are (v, ω) = J η + a; a = 0 where nothing depends on
 * t. Their rates are J η̇ + r. `body` is the name of a body, or of a point of `[points]`;
 * `point` has 3 numbers, its position along the axes of the body from there, or is null for that
 * place itself. The first call for a name derives J, as pc_system_new derives equations, for all
 * points. Returns PC_NOT_FOUND where there is no such body, and PC_INVALID_MODEL where its angular
 * velocity is given without a rotation.
 */
PC_API
pc_status pc_system_body_jacobian(const pc_system *system,
                                  double t,
                                  const double *y,
                                  size_t y_length,
                                  const char *body,
                                  const double *point,
                                  size_t point_length,
                                  double *jacobian,
                                  size_t length,
                                  pc_error **error);

/**
 * Writes the pose of a body at (t, y): the position r of one of its points along fixed axes, 3
 * numbers, followed by its rotation R, 3 × 3 and column-major, so `length` is 12. R takes
 * components along the axes of the body to those along fixed axes, so that its columns are the
 * axes of the body; a particle, and a point of the world, have the unit matrix. `body` and
 * `point` are as in pc_system_body_jacobian, whose J η + a is the rate of r. The first call for
 * a name derives the pose, as pc_system_new derives equations, for all points. Returns
 * PC_NOT_FOUND where there is no such body, and PC_INVALID_MODEL where its angular velocity is
 * given without a rotation.
 */
PC_API
pc_status pc_system_body_pose(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              const char *body,
                              const double *point,
                              size_t point_length,
                              double *pose,
                              size_t length,
                              pc_error **error);

/**
 * Writes the acceleration that a point of a body has at (t, y) besides J η̇, and the same part
 * of the angular acceleration of the body, along fixed axes: 6 numbers, (v̇, ω̇) − J η̇, which
 * is J̇ η where nothing depends on t. It is the last column of pc_system_body_jacobian, without
 * the others. With it η̇ = J⁺ (a − bias) gives the point the acceleration a. Otherwise like
 * pc_system_body_jacobian.
 */
PC_API
pc_status pc_system_body_bias(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              const char *body,
                              const double *point,
                              size_t point_length,
                              double *bias,
                              size_t length,
                              pc_error **error);

/**
 * Writes the generalised forces g, k numbers with k as in pc_system_mass_matrix, that hold the
 * system at rest in the position of (t, y): tau of pc_system_inverse_dynamics for η = 0 and η̇ =
 * 0, whatever the velocities of y are. They balance weight and springs, −X_s L at rest, and
 * those forces of the model that act at rest; external forces of the program, which are not
 * called, count as 0. The first call derives equations, as pc_system_new does.
 */
PC_API
pc_status pc_system_gravity(const pc_system *system,
                            double t,
                            const double *y,
                            size_t y_length,
                            double *tau,
                            size_t tau_length,
                            pc_error **error);

/**
 * Writes the derivatives ∂h/∂y of the observables h of pc_system_observe at (t, y), o × dim and
 * column-major for o = pc_system_observable_count, so `length` is o*dim. Observables that
 * contain accelerations or reactions change with these, and external forces with the state, as
 * they do in pc_system_jacobian. An entry is not finite where its observable has no derivative,
 * as that of a speed at rest, or no value. The first call derives them, as pc_system_new derives
 * equations.
 */
PC_API
pc_status pc_system_observable_jacobian(const pc_system *system,
                                        double t,
                                        const double *y,
                                        size_t y_length,
                                        double *jacobian,
                                        size_t length,
                                        pc_error **error);

/**
 * Writes the derivatives ∂h/∂p of the observables at (t, y) by all parameters, o × p and
 * column-major for p = pc_system_parameter_count, at constant external forces. For an input with
 * a table it is the derivative by a shift of its values; a parameter that is an expression in
 * others counts as one by itself. Otherwise like pc_system_observable_jacobian; it needs no
 * pc_model_differentiate.
 */
PC_API
pc_status pc_system_observable_parameter_jacobian(const pc_system *system,
                                                  double t,
                                                  const double *y,
                                                  size_t y_length,
                                                  double *jacobian,
                                                  size_t length,
                                                  pc_error **error);

/**
 * Linearises ẏ = f(t, y, u), h = h(t, y, u) at (t, y), which need not be an equilibrium:
 *
 *   δẏ = A δy + B δu,   δh = C δy + D δu,
 *
 * where u are all external forces, in the order of pc_system_force_name, then the parameters
 * with the indices `inputs`, such as inputs of the model; h are the observables of
 * pc_system_observe. In contrast to pc_system_jacobian, A is the derivative at constant u: that
 * of the open loop.
 *
 * `forces` are the values of the external forces, so that none needs to be set; NULL, of length
 * 0, for those of the function of pc_system_set_force. Parameters and inputs have their current
 * values. The matrices are column-major, for dim = pc_system_dim, o = pc_system_observable_count
 * and m the number of components of u: `a` is dim × dim, `b` dim × m, `c` o × dim and `d` o × m.
 * Those that are NULL, of length 0, are left out. Entries of C and D may be not finite, as those
 * of pc_system_observable_jacobian.
 *
 * Where constraints hold, the deviations δy of motions are those that satisfy them to first
 * order; pc_system_linearization has the equations in independent components. The first call
 * derives the matrices, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_linearize(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              const double *forces,
                              size_t forces_length,
                              const size_t *inputs,
                              size_t inputs_length,
                              double *a,
                              size_t a_length,
                              double *b,
                              size_t b_length,
                              double *c,
                              size_t c_length,
                              double *d,
                              size_t d_length,
                              pc_error **error);

/**
 * Linearises the equations of a model in independent components about a state near y: the state
 * itself, the steady motion, or the equilibrium, as `about`, a pc_about, says. Of the components
 * of the states that satisfy the constraints as many are kept as are independent there; a steady
 * motion is described without its cyclic coordinates, whose rates are constant.
 *
 * Newton's method holds the components with the indices `held` at their values in y, to choose
 * one of a family of steady motions; it does not leave the states that motions reach from y.
 * External forces are constant, with the values `forces`; NULL, of length 0, for those that the
 * function of pc_system_set_force has at (t, y). `inputs` are the indices of parameters that are
 * inputs; all external forces are. The system has to be in quasi-velocities of the model
 * (PC_POINCARE). The first call, and one with other inputs, derives equations, as pc_system_new
 * does.
 *
 * Returns PC_EVALUATION where no steady state is found, or the rates have no derivatives there,
 * and PC_UNSUPPORTED where steady states are sought for equations that depend on time, and for
 * other forms of the equations.
 */
PC_API
pc_status pc_system_linearization(const pc_system *system,
                                  int about,
                                  double t,
                                  const double *y,
                                  size_t y_length,
                                  const size_t *held,
                                  size_t held_length,
                                  const double *forces,
                                  size_t forces_length,
                                  const size_t *inputs,
                                  size_t inputs_length,
                                  pc_linearization **linearization,
                                  pc_error **error);

/**
 * The number of components, inputs or outputs, according to a pc_linear_part; 0 for NULL.
 */
PC_API size_t pc_linearization_count(const pc_linearization *linearization, int part);

/**
 * The name of a component, input or output, counted from 0, according to a pc_linear_part; an
 * external force has the name of its quasi-velocity. NULL beyond the last.
 */
PC_API
const char *pc_linearization_name(const pc_linearization *linearization,
                                  int part,
                                  size_t index);

/**
 * Returns 1 if the state is steady: all rates vanish but those of cyclic coordinates; else 0,
 * and 0 for NULL.
 */
PC_API int pc_linearization_is_steady(const pc_linearization *linearization);

/**
 * Writes the state of the system about which the equations were linearised: the equilibrium or
 * the steady motion that was found.
 */
PC_API
pc_status pc_linearization_state(const pc_linearization *linearization,
                                 double *y,
                                 size_t y_length,
                                 pc_error **error);

/**
 * Writes a matrix, a pc_linear_matrix, column-major; pc_linearization_count gives the numbers of
 * its rows and columns.
 */
PC_API
pc_status pc_linearization_matrix(const pc_linearization *linearization,
                                  int matrix,
                                  double *values,
                                  size_t length,
                                  pc_error **error);

/**
 * Frees a linearization. NULL is allowed.
 */
PC_API void pc_linearization_free(pc_linearization *linearization);

/**
 * Writes the value at (t, y) of the Poisson bracket (12), in coordinates and momenta, of two
 * functions,
 *
 *   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m,
 *
 * so that (x_i, H) = ẋ_i and (y_s, H) = ẏ_s where nothing depends on time and there are no
 * forces. The functions are expressions of the model in coordinates and velocities; the
 * momenta y_s = ∂L/∂η_s are substituted. Under nonholonomic constraints the bracket is the
 * almost-Poisson bracket of the independent momenta. Each call derives equations, as pc_system_new
 * does.
 */
PC_API
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
 * derives the transform, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_to_momenta(const pc_system *system,
                               double t,
                               const double *y,
                               size_t y_length,
                               double *result,
                               size_t result_length,
                               pc_error **error);

/**
 * Writes the state (x, η) with the quasi-velocities of the state (x, p). The first call derives
 * the transform, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_to_quasi_velocities(const pc_system *system,
                                        double t,
                                        const double *y,
                                        size_t y_length,
                                        double *result,
                                        size_t result_length,
                                        pc_error **error);

/**
 * Derives and prints the equations, as `pc derive` does: constraints, kinematics, brackets,
 * equations, energy and reactions, or momenta and Hamiltonian, and the operations of one
 * right-hand side. Where constraints are imposed by multipliers, the text shows the equations in
 * independent velocities. `format` is a pc_format. Parameters have the values of the model. Free
 * the text with pc_string_free.
 */
PC_API
pc_status pc_system_print(const pc_system *system,
                          int format,
                          char **text,
                          pc_error **error);

/**
 * Writes the equations as C source that does not depend on this library: the text of NAME.h
 * and of NAME.c, where NAME is `name`, turned into an identifier: Greek letters become their
 * names, runs of other characters one `_`, with none at the ends; `n_` precedes a leading digit,
 * `_` follows a keyword of C. The source has the right-hand side, its Jacobian, the mass matrix,
 * the energy, the integrals and the outputs in terms of independent quasi-velocities, or of
 * momenta if these are in the state of the system, and begins with a comment that explains its
 * use. External forces are parameters that come after the others; the name of each is `Q_`
 * followed by the name of its quasi-velocity, and they are zero until they are set. If `t_end` is
 * finite, the source can be compiled with -DNAME_MAIN (in capitals) into a program that integrates
 * from the start of the model to that time. Free both texts with pc_string_free.
 */
PC_API
pc_status pc_system_emit_c(const pc_system *system,
                           const char *name,
                           double t_end,
                           char **header,
                           char **source,
                           pc_error **error);

/**
 * Prints an analysis of the motions that is made without integrating them, as `pc theory` does:
 * momenta and their brackets, Dirac's brackets, Casimirs, integrals and their brackets, cyclic
 * displacements, invariant measure, Chaplygin's multiplier, Hamilton-Jacobi's equation with the
 * motion by Jacobi's theorem, steady motions, Routh's reduction. Each claim is marked as proved,
 * disproved or open. The integrals sought are polynomials of a `degree` from 1 to 6 in the
 * velocities, whose coefficients are polynomials in the coordinates times 1 or one of the
 * `functions`, expressions of the model; the list may be empty. `format` is a pc_format.
 * Parameters have the values of the model. Everything is derived again, which takes longer than
 * pc_system_print. Free the text with pc_string_free.
 */
PC_API
pc_status pc_system_theory(const pc_system *system,
                           int format,
                           size_t degree,
                           const char *const *functions,
                           size_t function_count,
                           char **text,
                           pc_error **error);

/**
 * Tests functions as canonical variables, as `pc theory --canonical` does, and prints the momenta
 * with the result: whether the brackets (X_i, Y_j) of the functions are c δ_ij with a constant c
 * and all others zero. The `count` functions, each with its name, are first the new coordinates
 * X_i, then as many new momenta Y_j: expressions of the model in coordinates, velocities and the
 * momenta p_x. `format` is a pc_format. Parameters have the values of the model. Everything is
 * derived again. Free the text with pc_string_free.
 */
PC_API
pc_status pc_system_canonical_variables(const pc_system *system,
                                        int format,
                                        const char *const *names,
                                        const char *const *functions,
                                        size_t count,
                                        char **text,
                                        pc_error **error);

/**
 * Derives the equations of the model a second time, by a route that shares only the text of the
 * model with the first, and compares both at `states` random states on the constraints, for the
 * current parameters: velocities, accelerations or rates of momenta, reactions, the energy and its
 * rate of change, integrals and outputs. A value of 0 stands for 100 states. `text` says how
 * closely they agree and what was not compared, on separate lines; it may be NULL, and is freed
 * with pc_string_free. External forces are taken to be 0. Returns PC_DISAGREEMENT, with the
 * quantity and both its values, if the two derivations differ, which is a defect of the library;
 * PC_UNSUPPORTED if there is no second derivation for this model. The call takes as long as
 * pc_system_new.
 */
PC_API
pc_status pc_system_verify(const pc_system *system,
                           size_t states,
                           char **text,
                           pc_error **error);

/**
 * As pc_system_verify, but at one state of the system, such as that of a solver: its time, and the
 * state that pc_solver_advance has written.
 */
PC_API
pc_status pc_system_verify_at(const pc_system *system,
                              double t,
                              const double *y,
                              size_t y_length,
                              char **text,
                              pc_error **error);

/**
 * Makes a kernel of the system with its current parameters.
 */
PC_API pc_status pc_kernel_new(const pc_system *system, pc_kernel **kernel, pc_error **error);

/**
 * Frees a kernel. NULL is allowed.
 */
PC_API void pc_kernel_free(pc_kernel *kernel);

/**
 * Sets all parameters of a kernel, in the order of pc_system_parameter_name.
 */
PC_API
pc_status pc_kernel_set_parameters(pc_kernel *kernel,
                                   const double *values,
                                   size_t length,
                                   pc_error **error);

/**
 * Writes ydot = f(t, y), both of pc_system_dim numbers, which is not checked; they must not
 * share memory. `kernel` is a pc_kernel of this thread.
 *
 * Returns 0 on success, 1 where f cannot be evaluated but a smaller step may help, and −1 where no
 * step helps. pc_system_rhs at the same (t, y) says why. It has the form of the functions that
 * GSL's odeiv2 takes, with the kernel as `params`.
 */
PC_API
int pc_kernel_rhs(double t,
                  const double *y,
                  double *ydot,
                  void *kernel);

/**
 * Writes ∂f/∂y, dim × dim and column-major; otherwise it is like pc_kernel_rhs. The first call
 * compiles it.
 */
PC_API
int pc_kernel_jacobian(double t,
                       const double *y,
                       double *jacobian,
                       void *kernel);

/**
 * Writes f(t, y) for `count` states, which are given one after the other in `states`, to `rates`,
 * in the same order. Otherwise it is like pc_kernel_rhs: it returns 1 if f cannot be evaluated at
 * some states, whose rates are then NaN; it returns −1 at a state where no step helps, and does
 * not write the rates of the states after it.
 */
PC_API
int pc_kernel_rhs_many(double t,
                       const double *states,
                       size_t count,
                       double *rates,
                       void *kernel);

/**
 * The dimension of a kernel's state; 0 for NULL.
 */
PC_API size_t pc_kernel_dim(const pc_kernel *kernel);

/**
 * Makes a solver that integrates the system from the state y at the time t, with its current
 * parameters, or from the start of the model if y is NULL, of length 0; t is then ignored.
 * `options` may be NULL. Projection after each step keeps states on the constraints, and the
 * integrals of pc_model_keep at their values at this start. The events of the model are followed:
 * where one occurs, the state is reset as the model says, and a terminal event ends the call with
 * PC_EVENT.
 */
PC_API
pc_status pc_solver_new(const pc_system *system,
                        const pc_solver_options *options,
                        double t,
                        const double *y,
                        size_t y_length,
                        pc_solver **solver,
                        pc_error **error);

/**
 * Frees a solver. NULL is allowed. It does nothing when called from an observer or function of
 * this solver.
 */
PC_API void pc_solver_free(pc_solver *solver);

/**
 * Makes a solver continue with the current parameters and inputs of the system: it restarts
 * at its current state, at order 1. This is how inputs change between two calls of
 * pc_solver_advance. The system must be that of the solver, or one of the same model. Returns
 * PC_UNSUPPORTED if the solver has events added by pc_solver_add_event.
 */
PC_API
pc_status pc_solver_take_parameters(pc_solver *solver,
                                    const pc_system *system,
                                    pc_error **error);

/**
 * Integrates to the time t, in the direction of the first step, and writes the state there.
 * When PC_EVENT or PC_STOPPED is returned, it is the state where the integration ended, and
 * pc_solver_time gives the time; the next call continues from there. After a failure
 * pc_solver_time and pc_solver_state give the time and state that were reached. PC_LIMIT is such a
 * failure; it is due to the time limit or the pc_cancel of the system's options.
 */
PC_API
pc_status pc_solver_advance(pc_solver *solver,
                            double t,
                            double *y,
                            size_t y_length,
                            pc_error **error);

/**
 * Takes one internal step in the direction of `towards`, or the part of it before an event, and
 * writes the time at its end, which may lie beyond `towards`, and the state there; both are also
 * written when PC_EVENT or PC_STOPPED is returned.
 */
PC_API
pc_status pc_solver_step(pc_solver *solver,
                         double towards,
                         double *t,
                         double *y,
                         size_t y_length,
                         pc_error **error);

/**
 * Integrates through the times, which increase or decrease throughout, and calls `observer`
 * at each with the state, which is valid during the call, and with `user`. Returns PC_STOPPED if
 * the observer stops it. At the time of an event the observer receives the state after the event;
 * at a terminal event the observer is called for the last time, and PC_EVENT is returned.
 */
PC_API
pc_status pc_solver_run(pc_solver *solver,
                        const double *times,
                        size_t times_length,
                        pc_observer observer,
                        void *user,
                        pc_error **error);

/**
 * Writes the current time of the integration.
 */
PC_API pc_status pc_solver_time(const pc_solver *solver, double *t, pc_error **error);

/**
 * Writes the current state of the integration.
 */
PC_API
pc_status pc_solver_state(const pc_solver *solver,
                          double *y,
                          size_t y_length,
                          pc_error **error);

/**
 * Puts a solver at the state y and the time t, as a new solver would be that pc_solver_new makes
 * with the same options: the method, the statistics, the counts of events and the integrals that
 * are kept begin anew, and either direction of time may follow. Events that were added,
 * observers, sensitivities with their starts, and the parameters that the solver has, stay.
 * After a failure the solver is as it was.
 */
PC_API
pc_status pc_solver_reset(pc_solver *solver,
                          double t,
                          const double *y,
                          size_t y_length,
                          pc_error **error);

/**
 * Sets the function that is called after each internal step from now on, in all calls that
 * integrate, on their thread, in place of the previous one; NULL for none. It follows the work
 * of the method, shows progress, or stops the integration; it does not change the steps.
 * `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails or
 * `monitor` is NULL, else when another monitor takes its place or the solver is freed. `destroy`
 * must not use the solver while the solver is being freed.
 */
PC_API
pc_status pc_solver_set_monitor(pc_solver *solver,
                                pc_monitor monitor,
                                void *user,
                                pc_destroy destroy,
                                pc_error **error);

/**
 * Writes what the error test of the last internal step compared, at its end: the weights 1/(rtol
 * |y_i| + atol_i) of the components, and the estimated local errors e_i. A step is accepted if
 * the root mean square of the products is at most 1. Each of the two arrays has the length of
 * the state; one that is NULL, of length 0, is left out. PC_ADAMS, PC_BDF and the BDF steps of
 * PC_AUTO have estimates of each component; for other steps the errors are refused with
 * PC_UNSUPPORTED. Before the first step they are refused with PC_INVALID_ARGUMENT.
 */
PC_API
pc_status pc_solver_errors(const pc_solver *solver,
                           double *weights,
                           size_t weights_length,
                           double *errors,
                           size_t errors_length,
                           pc_error **error);

/**
 * Sets the observer that is called for each event from now on, in place of the previous one; NULL
 * for none. `user` must stay valid until another observer is set or the solver is freed. The
 * observer is called during the calls that integrate, on their thread.
 */
PC_API
pc_status pc_solver_observe_events(pc_solver *solver,
                                   pc_event_observer observer,
                                   void *user,
                                   pc_error **error);

/**
 * The same as pc_solver_observe_events, with a `user` that the solver owns. `destroy`, unless
 * NULL, is called with `user` exactly once: by this call if it fails or `observer` is NULL, else
 * when another observer takes its place or the solver is freed. `destroy` must not use the solver
 * while the solver is being freed.
 */
PC_API
pc_status pc_solver_set_event_observer(pc_solver *solver,
                                       pc_event_observer observer,
                                       void *user,
                                       pc_destroy destroy,
                                       pc_error **error);

/**
 * Follows an event of your program, numbered after those of the model and those added before: it
 * occurs where `function` passes through zero in the given direction, a pc_direction. There
 * `reset`, unless NULL, changes the state, which is then projected onto the constraints; if
 * `terminal` is not 0 the event ends the call with PC_EVENT. The call must be made before the
 * first step. `name` is for messages.
 *
 * `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else by
 * pc_solver_free. `destroy` must not use the solver.
 */
PC_API
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
 * The number of events that a solver follows: those of the model, then those added; 0 for NULL.
 */
PC_API size_t pc_solver_event_count(const pc_solver *solver);

/**
 * The name of an event, counted from 0; NULL beyond the last.
 */
PC_API const char *pc_solver_event_name(const pc_solver *solver, size_t index);

/**
 * Writes the number of times an event has occurred since the solver was made.
 */
PC_API
pc_status pc_solver_event_occurrences(const pc_solver *solver,
                                      size_t event,
                                      uint64_t *occurrences,
                                      pc_error **error);

/**
 * Writes when an event last occurred, and the states before and after. Returns PC_NOT_FOUND if it
 * has not occurred. Only the last occurrence is recorded; an observer sees all of them. `before`
 * and `after` may be NULL, of length 0.
 */
PC_API
pc_status pc_solver_last_occurrence(const pc_solver *solver,
                                    size_t event,
                                    double *t,
                                    double *before,
                                    size_t before_length,
                                    double *after,
                                    size_t after_length,
                                    pc_error **error);

/**
 * Writes the number of the terminal event that ended the last call that integrated; returns
 * PC_NOT_FOUND if none did.
 */
PC_API
pc_status pc_solver_terminal_event(const pc_solver *solver,
                                   size_t *event,
                                   pc_error **error);

/**
 * Writes the derivative of the start of the model with respect to parameter number `parameter`,
 * counted from 0: start values may be expressions in parameters. The call derives the equations.
 * Returns PC_INCONSISTENT_MODEL where there is no start for nearby values of the parameter, for an
 * input with a table, and for a parameter that is an expression in others.
 */
PC_API
pc_status pc_system_start_by_parameter(const pc_system *system,
                                       size_t parameter,
                                       double *column,
                                       size_t column_length,
                                       pc_error **error);

/**
 * Adds, before the first step, a sensitivity that a solver integrates with the motion: the
 * derivative of the state with respect to parameter number `parameter`, counted from 0. `start` is
 * the derivative of the start, which pc_system_start_by_parameter gives for the start of the
 * model; NULL, of length 0, for a start that does not depend on the parameter. Requires that
 * pc_model_differentiate was called. Sensitivities jump where an event of the model resets the
 * state; with an event of the program that does so, the call returns PC_INVALID_ARGUMENT. For an
 * input with a table, the sensitivity is the derivative with respect to a shift of all values of
 * the table.
 */
PC_API
pc_status pc_solver_add_sensitivity(pc_solver *solver,
                                    size_t parameter,
                                    const double *start,
                                    size_t start_length,
                                    pc_error **error);

/**
 * Writes sensitivity number `number`, counted from 0 in the order in which sensitivities were
 * added, at the time of the solver; it has the length of the state.
 */
PC_API
pc_status pc_solver_sensitivity(const pc_solver *solver,
                                size_t number,
                                double *column,
                                size_t column_length,
                                pc_error **error);

/**
 * Writes the derivative of y of the given order, 0 for y itself, at a time in the last internal
 * step, from the polynomial of the method, whose degree is the order of that step. The step
 * extends from step_time − last_step to step_time of pc_statistics, but not beyond an event; there
 * is no such step before the first step or just after a reset. y satisfies the constraints; its
 * derivatives are those of the polynomial.
 */
PC_API
pc_status pc_solver_interpolate(pc_solver *solver,
                                double t,
                                unsigned int derivative,
                                double *y,
                                size_t y_length,
                                pc_error **error);

/**
 * Integrates to the time t, which must differ from that of the solver, as pc_solver_advance
 * does, and records the motion from the previous time of the solver on; this takes (order + 2) ×
 * dim numbers for each internal step. `dense` is also made when PC_EVENT or PC_STOPPED is
 * returned; it then ends where the integration ended.
 */
PC_API
pc_status pc_solver_run_dense(pc_solver *solver,
                              double t,
                              pc_dense **dense,
                              pc_error **error);

/**
 * Writes y(t). At an event this is the state after the event, except at the very end of the
 * motion, where it is the limit from before. Inside a step the state deviates from the constraints
 * by the error of a step; pc_system_project moves it onto the constraints.
 */
PC_API
pc_status pc_dense_eval(const pc_dense *dense,
                        double t,
                        double *y,
                        size_t y_length,
                        pc_error **error);

/**
 * Writes the rate of y at t. The rate may jump by the error of a step where one step meets the
 * next.
 */
PC_API
pc_status pc_dense_rate(const pc_dense *dense,
                        double t,
                        double *ydot,
                        size_t ydot_length,
                        pc_error **error);

/**
 * The length of the state; 0 for NULL.
 */
PC_API size_t pc_dense_dim(const pc_dense *dense);

/**
 * The time at which the motion begins; NaN for NULL.
 */
PC_API double pc_dense_t_begin(const pc_dense *dense);

/**
 * The time at which the motion ends, which precedes its beginning if the motion runs backwards in
 * time; NaN for NULL.
 */
PC_API double pc_dense_t_end(const pc_dense *dense);

/**
 * Frees a motion. NULL is allowed.
 */
PC_API void pc_dense_free(pc_dense *dense);

/**
 * Writes the time and state of a solver as bytes, to be freed with pc_bytes_free and read by
 * pc_solver_restore, possibly in another run of the program. `label` says what the checkpoint
 * belongs to; NULL means the empty text.
 *
 * A multistep method depends on earlier steps, so this solver restarts here too, at order 1:
 * from here on, it and the solvers restored from the checkpoint give the same numbers to the
 * last bit. Events of the model are part of the checkpoint; for a solver with events added by
 * pc_solver_add_event the call returns PC_UNSUPPORTED.
 */
PC_API
pc_status pc_solver_checkpoint(pc_solver *solver,
                               const char *label,
                               void **data,
                               size_t *length,
                               pc_error **error);

/**
 * Makes a solver that continues from a checkpoint, with the current parameters of the system.
 * It continues exactly as the original solver did if the system, the parameters and the options
 * are the same. `options` may be NULL. Returns PC_INVALID_CHECKPOINT unless the bytes are exactly
 * what pc_solver_checkpoint wrote, for a model with the same names and equations; the values of
 * parameters may differ. The statistics of the solver count the work from the checkpoint on.
 */
PC_API
pc_status pc_solver_restore(const pc_system *system,
                            const pc_solver_options *options,
                            const void *data,
                            size_t length,
                            pc_solver **solver,
                            pc_error **error);

/**
 * Writes the label of a checkpoint, to be freed with pc_string_free. Returns PC_INVALID_CHECKPOINT
 * in the same cases as pc_solver_restore.
 */
PC_API
pc_status pc_checkpoint_label(const void *data,
                              size_t length,
                              char **label,
                              pc_error **error);

/**
 * Frees the bytes of a checkpoint. NULL is allowed.
 */
PC_API void pc_bytes_free(void *data);

/**
 * Writes the statistics so far. `size` is sizeof(pc_statistics).
 */
PC_API
pc_status pc_solver_statistics(const pc_solver *solver,
                               pc_statistics *statistics,
                               size_t size,
                               pc_error **error);

/**
 * Integrates many members through the times, each from its own state and with its own parameters,
 * as a single solver would: the numbers are the same for any number of threads. The events of the
 * model are followed. With PC_AUTO and PC_DOP853, members of a model without events, constraints,
 * integrals to be kept, tables or explicit dependence on time are integrated side by side in
 * vectors: their last digits may differ from those of a solver, within the tolerances. With
 * PC_AUTO, members that turn out to be stiff are integrated by themselves.
 *
 * `states` has members × dim numbers, member by member, at the time t; NULL for the start of
 * the model, and then t is ignored. `parameters` has members × pc_system_parameter_count
 * numbers; NULL for the current parameters of the system. The length given with NULL is 0.
 * `options` may be NULL. `threads` is the number of threads, 0 for one on each core; all of them
 * have ended when the call returns. A member that fails is passed to the observer like any other,
 * with the rows that it reached, and the others continue. An error that all members share, such as
 * one in the times, is reported for each member. Returns PC_STOPPED if the observer stops the
 * ensemble, and PC_LIMIT if the time limit or the pc_cancel of the system's options ends it; the
 * members that were finished have then been passed to the observer. The system may be used during
 * the call.
 */
PC_API
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

/**
 * Writes the largest Lyapunov exponents of the motion from the state y at the time t, in units
 * of inverse time and in descending order as far as they have converged; `exponents_length` is
 * their number, from 1 to the length of the state. As many deviations are integrated with the
 * motion and are made orthonormal again after each interval of time; the exponents are their
 * mean rates of growth over `intervals` intervals, after the first `transient` of them, which do
 * not count. The interval should be so short that its product with the difference of the
 * exponents is below 10. `options` may be NULL. Events of the model are not followed. Takes as
 * long as an integration over all intervals; PC_LIMIT as for a solver.
 */
PC_API
pc_status pc_system_lyapunov(const pc_system *system,
                             const pc_solver_options *options,
                             double t,
                             const double *y,
                             size_t y_length,
                             double interval,
                             uint32_t intervals,
                             uint32_t transient,
                             double *exponents,
                             size_t exponents_length,
                             pc_error **error);

/**
 * Writes the value of G = h(t_end) + ∫ g dt along the motion from the state y at the time t, and
 * its derivatives by this state, ∂G/∂y_i with the other components held fixed, and by all
 * parameters, ∂G/∂p_j for a start that does not depend on them; to what they are for a start
 * that does, pc_system_start_by_parameter adds Σ ∂y_i/∂p_j ∂G/∂y_i.
 *
 * h and g are observables, given by their indices `end` and `density`; SIZE_MAX stands for 0.
 * The motion is integrated forwards and the adjoint equations backwards, once each however many
 * parameters there are, by PC_BDF if `options`, which may be NULL, say so, else by PC_ADAMS. The
 * derivatives are continued across the events of the model. `by_parameters` needs
 * pc_model_differentiate; it may be NULL, of length 0. The first call derives the derivatives of
 * observables, as pc_system_new derives equations.
 */
PC_API
pc_status pc_system_gradient(const pc_system *system,
                             const pc_solver_options *options,
                             double t,
                             const double *y,
                             size_t y_length,
                             double t_end,
                             size_t end,
                             size_t density,
                             double *value,
                             double *by_start,
                             size_t by_start_length,
                             double *by_parameters,
                             size_t by_parameters_length,
                             pc_error **error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PC_H */
