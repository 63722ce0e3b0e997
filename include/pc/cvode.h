/*
 * pc/cvode.h: the equations of a pc_system for your own CVODE or CVODES of SUNDIALS 6 or 7, in C99
 * or C++.
 *
 *     pc_cvode equations;
 *     if (pc_cvode_init(&equations, system, &error) == PC_OK) {
 *         CVodeInit(cvode, pc_cvode_rhs, t, y);
 *         CVodeSetUserData(cvode, &equations);
 *         CVodeSetLinearSolver(cvode, solver, matrix);   the matrix dense, or sparse by columns
 *         CVodeSetJacFn(cvode, pc_cvode_jac);
 *         CVodeSetProjFn(cvode, pc_cvode_proj);          for CV_BDF, to keep constraints and integrals
 *         CVodeRootInit(cvode, pc_cvode_root_count(&equations), pc_cvode_roots);
 *         CVode(cvode, ...);                             at a root pc_cvode_reset, then CVodeReInit
 *     }
 *     pc_cvode_free(&equations);
 *
 * The user data of all functions is a pc_cvode; each integration has its own. Nothing here is
 * compiled into libpc, which contains another SUNDIALS and exports none of it: the two are
 * independent. Vectors are those whose numbers N_VGetArrayPointer gives, such as those of
 * N_VNew_Serial, of the length pc_system_dim.
 *
 * The functions return what CVODE expects: 0; 1 where the equations cannot be evaluated, so that
 * CVODE tries a smaller step; -1 where no step helps. Then `error` of the pc_cvode says why; it is
 * NULL if a vector, a matrix or the roots do not fit, or a root is NaN.
 */

#ifndef PC_CVODE_H
#define PC_CVODE_H

#include <stdlib.h>

#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <pc.h>

#ifndef SUNDIALS_DOUBLE_PRECISION
#error "pc/cvode.h needs a SUNDIALS of double precision"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A root in addition to the events of the model: where the observable of this index, as for
 * pc_system_observable_name, has this value. */
typedef struct {
    size_t observable;
    double value;
} pc_cvode_root;

/* The equations of an integration, made by pc_cvode_init. Change only the members that are said to
 * be yours to set. */
typedef struct {
    /* Its own copies. To set parameters, call both pc_kernel_set_parameters and
     * pc_system_set_parameters. */
    pc_kernel *kernel;
    pc_system *system;
    /* Yours to set before CVodeRootInit: an array that you keep, and its length. */
    const pc_cvode_root *roots;
    size_t roots_length;
    /* Why a function failed last, or NULL. */
    pc_error *error;
    /* Room for all observables, and for a state. */
    double *observables, *state;
} pc_cvode;

/* Frees what pc_cvode_init made. It may be called twice. */
static inline void pc_cvode_free(pc_cvode *equations)
{
    pc_kernel_free(equations->kernel);
    pc_system_free(equations->system);
    pc_error_free(equations->error);
    free(equations->observables);
    free(equations->state);
    equations->kernel = NULL;
    equations->system = NULL;
    equations->error = NULL;
    equations->observables = NULL;
    equations->state = NULL;
}

/* Takes the equations of a system with its current parameters, and no roots. After a failure
 * nothing has to be freed; PC_INTERNAL without an error means that memory is exhausted. */
static inline pc_status pc_cvode_init(pc_cvode *equations, const pc_system *system, pc_error **error)
{
    const size_t observables = pc_system_observable_count(system);
    pc_status status;
    equations->kernel = NULL;
    equations->system = NULL;
    equations->roots = NULL;
    equations->roots_length = 0;
    equations->error = NULL;
    equations->observables = NULL;
    equations->state = NULL;
    status = pc_system_clone(system, &equations->system, error);
    if (status == PC_OK) {
        status = pc_kernel_new(equations->system, &equations->kernel, error);
    }
    if (status == PC_OK) {
        equations->observables = (double *)malloc((observables + 1) * sizeof(double));
        equations->state = (double *)malloc(pc_system_dim(system) * sizeof(double));
        status = equations->observables && equations->state ? PC_OK : PC_INTERNAL;
    }
    if (status != PC_OK) {
        pc_cvode_free(equations);
    }
    return status;
}

/* The numbers of a vector, if it has the length `dim`. */
static inline double *pc_cvode_numbers(N_Vector vector, size_t dim)
{
    return N_VGetLength(vector) == (sunindextype)dim ? N_VGetArrayPointer(vector) : NULL;
}

/* What CVODE expects for a status, with the error that belongs to it. */
static inline int pc_cvode_answer(const pc_cvode *equations, pc_status status)
{
    return status == PC_OK ? 0 : pc_error_is_recoverable(equations->error) ? 1 : -1;
}

/* The place for the next error, which replaces the last one. */
static inline pc_error **pc_cvode_error(pc_cvode *equations)
{
    pc_error_free(equations->error);
    equations->error = NULL;
    return &equations->error;
}

/* The answer where an argument does not fit, without an error: it removes that of an earlier call.
 * */
static inline int pc_cvode_misfit(pc_cvode *equations)
{
    pc_cvode_error(equations);
    return -1;
}

/* CVRhsFn: ẏ = f(t, y). */
static inline int pc_cvode_rhs(double t, N_Vector y, N_Vector ydot, void *user_data)
{
    pc_cvode *equations = (pc_cvode *)user_data;
    const size_t n = pc_kernel_dim(equations->kernel);
    double *from = pc_cvode_numbers(y, n), *to = pc_cvode_numbers(ydot, n);
    int answer;
    if (!from || !to) {
        return pc_cvode_misfit(equations);
    }
    answer = pc_kernel_rhs(t, from, to, equations->kernel);
    if (answer != 0) {
        /* Only the system says why. */
        pc_system_rhs(equations->system, t, from, n, to, n, pc_cvode_error(equations));
    }
    return answer;
}

/* The Jacobian as a sparse matrix by columns. */
static inline int pc_cvode_sparse_jac(double t, const double *y, SUNMatrix jacobian, pc_cvode *equations)
{
    const size_t n = pc_kernel_dim(equations->kernel);
    size_t entries = 0, i;
    const size_t *starts = NULL, *rows = NULL;
    pc_status status = pc_system_jacobian_pattern(equations->system, &entries, &starts, &rows, pc_cvode_error(equations));
    if (status != PC_OK) {
        return pc_cvode_answer(equations, status);
    }
    if (SM_SPARSETYPE_S(jacobian) != CSC_MAT || SM_NNZ_S(jacobian) < (sunindextype)entries) {
        return -1;
    }
    for (i = 0; i <= n; i++) {
        SM_INDEXPTRS_S(jacobian)[i] = (sunindextype)starts[i];
    }
    for (i = 0; i < entries; i++) {
        SM_INDEXVALS_S(jacobian)[i] = (sunindextype)rows[i];
    }
    status = pc_system_sparse_jacobian(equations->system, t, y, n, SM_DATA_S(jacobian), entries, pc_cvode_error(equations));
    return pc_cvode_answer(equations, status);
}

/* CVLsJacFn: ∂f/∂y, for SUNDenseMatrix, and for SUNSparseMatrix of type CSC_MAT with room for the entries that
 * pc_system_jacobian_pattern counts. */
static inline int pc_cvode_jac(double t, N_Vector y, N_Vector fy, SUNMatrix jacobian, void *user_data, N_Vector tmp1,
                               N_Vector tmp2, N_Vector tmp3)
{
    pc_cvode *equations = (pc_cvode *)user_data;
    const size_t n = pc_kernel_dim(equations->kernel);
    const double *from = pc_cvode_numbers(y, n);
    int answer;
    (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
    if (from && SUNMatGetID(jacobian) == SUNMATRIX_SPARSE && SM_COLUMNS_S(jacobian) == (sunindextype)n) {
        return pc_cvode_sparse_jac(t, from, jacobian, equations);
    }
    if (!from || SUNMatGetID(jacobian) != SUNMATRIX_DENSE || SM_LDATA_D(jacobian) != (sunindextype)(n * n)) {
        return pc_cvode_misfit(equations);
    }
    answer = pc_kernel_jacobian(t, from, SM_DATA_D(jacobian), equations->kernel);
    if (answer != 0) {
        pc_system_jacobian(equations->system, t, from, n, SM_DATA_D(jacobian), n * n, pc_cvode_error(equations));
    }
    return answer;
}

/* CVLsJacTimesVecFn: (∂f/∂y) v, for Krylov solvers. */
static inline int pc_cvode_jtimes(N_Vector v, N_Vector product, double t, N_Vector y, N_Vector fy, void *user_data,
                                  N_Vector tmp)
{
    pc_cvode *equations = (pc_cvode *)user_data;
    const size_t n = pc_kernel_dim(equations->kernel);
    const double *at = pc_cvode_numbers(y, n), *along = pc_cvode_numbers(v, n);
    double *to = pc_cvode_numbers(product, n);
    pc_status status;
    (void)fy, (void)tmp;
    if (!at || !along || !to) {
        return pc_cvode_misfit(equations);
    }
    status = pc_system_jvp(equations->system, t, at, n, along, n, to, n, pc_cvode_error(equations));
    return pc_cvode_answer(equations, status);
}

/* CVProjFn: the correction c that moves the state to Π(y) = y + c, where constraints are satisfied and the integrals of
 * pc_model_keep have their values at the start of the model, to rounding, whatever `tolerance` is. Where CVODE starts from
 * another state, say pc_system_keep_from(equations.system, t, y, n, &error).
 *
 * The error estimate e is projected as CVODE asks, by the derivative of Π at y + c, which is
 * Π(y + c + e) - (y + c) up to terms of order e². This is the error that remains after projection;
 * across the surface none remains.
 *
 * CVODE projects at the ends of steps, with CV_BDF only, and interpolates between them: states that CVode gives in CV_NORMAL
 * are off the surface by the error of a step. Let it stop at the times wanted (CVodeSetStopTime), or use pc_system_project. */
static inline int pc_cvode_proj(double t, N_Vector y, N_Vector correction, double tolerance, N_Vector error_estimate,
                                void *user_data)
{
    pc_cvode *equations = (pc_cvode *)user_data;
    const size_t n = pc_kernel_dim(equations->kernel);
    const double *from = pc_cvode_numbers(y, n);
    double *c = pc_cvode_numbers(correction, n), *e = error_estimate ? pc_cvode_numbers(error_estimate, n) : NULL;
    pc_status status;
    size_t i;
    (void)tolerance;
    if (!from || !c || (error_estimate && !e)) {
        return pc_cvode_misfit(equations);
    }
    for (i = 0; i < n; i++) {
        c[i] = from[i];
    }
    status = pc_system_project(equations->system, t, c, n, pc_cvode_error(equations));
    if (status == PC_OK && e) {
        for (i = 0; i < n; i++) {
            e[i] += c[i];
        }
        status = pc_system_project(equations->system, t, e, n, pc_cvode_error(equations));
        for (i = 0; i < n; i++) {
            e[i] -= c[i];
        }
    }
    for (i = 0; i < n; i++) {
        c[i] -= from[i];
    }
    return pc_cvode_answer(equations, status);
}

/* How many roots there are, for CVodeRootInit: the events of the model, then those of `roots`. */
static inline int pc_cvode_root_count(const pc_cvode *equations)
{
    return (int)(pc_system_event_count(equations->system) + equations->roots_length);
}

/* CVRootFn: the functions of the events of the model, in the order of pc_system_event_name, then for each of `roots` its
 * observable less its value. For the directions of the events CVodeSetRootDirection takes the numbers of
 * pc_system_event_direction. */
static inline int pc_cvode_roots(double t, N_Vector y, double *gout, void *user_data)
{
    pc_cvode *equations = (pc_cvode *)user_data;
    const size_t n = pc_kernel_dim(equations->kernel), events = pc_system_event_count(equations->system);
    const size_t observables = equations->roots_length > 0 ? pc_system_observable_count(equations->system) : 0;
    const double *from = pc_cvode_numbers(y, n);
    pc_status status;
    size_t i;
    if (!from) {
        return pc_cvode_misfit(equations);
    }
    status = pc_system_events(equations->system, t, from, n, gout, events, pc_cvode_error(equations));
    if (status == PC_OK && observables > 0) {
        status = pc_system_observe(equations->system, t, from, n, equations->observables, observables,
                                   pc_cvode_error(equations));
    }
    if (status != PC_OK) {
        return pc_cvode_answer(equations, status);
    }
    for (i = 0; i < equations->roots_length; i++) {
        const pc_cvode_root root = equations->roots[i];
        if (root.observable >= observables) {
            return -1;
        }
        gout[events + i] = equations->observables[root.observable] - root.value;
    }
    for (i = 0; i < events + equations->roots_length; i++) {
        if (gout[i] != gout[i]) {
            return -1; /* CVODE would ignore NaN. */
        }
    }
    return 0;
}

/* Turns y before an event of the model, by its number among the roots, into the state after it, on
 * the constraints; kept integrals have their values there from now on. Then restart CVODE there, by
 * CVodeReInit. Events without resets, `roots` and failures leave y unchanged. */
static inline int pc_cvode_reset(double t, N_Vector y, size_t event, pc_cvode *equations)
{
    const size_t n = pc_kernel_dim(equations->kernel);
    double *numbers = pc_cvode_numbers(y, n), *state = equations->state;
    pc_status status = PC_OK;
    size_t i;
    if (!numbers) {
        return pc_cvode_misfit(equations);
    }
    if (!pc_system_event_resets(equations->system, event)) {
        return 0;
    }
    for (i = 0; i < n; i++) {
        state[i] = numbers[i];
    }
    status = pc_system_event_reset(equations->system, event, t, state, n, pc_cvode_error(equations));
    if (status == PC_OK) {
        status = pc_system_keep_from(equations->system, t, state, n, pc_cvode_error(equations));
    }
    if (status == PC_OK) {
        status = pc_system_project(equations->system, t, state, n, pc_cvode_error(equations));
    }
    for (i = 0; i < n && status == PC_OK; i++) {
        numbers[i] = state[i];
    }
    return pc_cvode_answer(equations, status);
}

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* PC_CVODE_H */
