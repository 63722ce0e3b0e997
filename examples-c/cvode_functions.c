/* The functions that pc/cvode.h gives CVODE, on a heavy top: the Jacobian as a dense and as a sparse
 * matrix, its product with a vector, a projection with the error estimate, and errors of f. */
#include <math.h>
#include <stdio.h>

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <pc/cvode.h>

enum { DIM = 6 };

static int wrong = 0;

static void check(int right, const char *what)
{
    printf("%-60s %s\n", what, right ? "right" : "WRONG");
    wrong += !right;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int main(void)
{
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_error *error = NULL;
    pc_cvode equations;
    pc_cvode_root root = {0, 0.25};
    SUNContext context;
    double t, state[DIM], rate[DIM], expected[DIM], c[DIM], e[DIM], g, worst, normal;
    size_t entries, k;
    int i, j;

    if (pc_model_builtin("heavy-top-lagrange", &model, &error) != PC_OK ||
        pc_model_keep(model, "norm", &error) != PC_OK || pc_system_new(model, NULL, &top, &error) != PC_OK ||
        pc_system_start(top, &t, state, DIM, &error) != PC_OK ||
        pc_system_jacobian_pattern(top, &entries, NULL, NULL, &error) != PC_OK ||
        pc_cvode_init(&equations, top, &error) != PC_OK || SUNContext_Create(0, &context) != 0) {
        fprintf(stderr, "%s\n", error ? pc_error_message(error) : "no memory");
        return 1;
    }
    N_Vector y = N_VMake_Serial(DIM, state, context), ydot = N_VMake_Serial(DIM, rate, context);
    N_Vector correction = N_VMake_Serial(DIM, c, context), estimate = N_VMake_Serial(DIM, e, context);
    N_Vector shorter = N_VNew_Serial(DIM - 1, context);
    SUNMatrix dense = SUNDenseMatrix(DIM, DIM, context);
    SUNMatrix sparse = SUNSparseMatrix(DIM, DIM, (sunindextype)entries, CSC_MAT, context);
    SUNMatrix by_rows = SUNSparseMatrix(DIM, DIM, (sunindextype)entries, CSR_MAT, context);

    pc_system_rhs(top, t, state, DIM, expected, DIM, NULL);
    i = pc_cvode_rhs(t, y, ydot, &equations);
    for (j = 0; j < DIM; j++) {
        i += rate[j] != expected[j];
    }
    check(i == 0, "f is that of the system, to the last bit");

    i = pc_cvode_jac(t, y, ydot, dense, &equations, NULL, NULL, NULL);
    i += pc_cvode_jac(t, y, ydot, sparse, &equations, NULL, NULL, NULL);
    for (worst = 0.0, k = 0, j = 0; j < DIM; j++) {
        for (; k < (size_t)SM_INDEXPTRS_S(sparse)[j + 1]; k++) {
            double *entry = &SM_ELEMENT_D(dense, SM_INDEXVALS_S(sparse)[k], j);
            worst = fmax(worst, fabs(*entry - SM_DATA_S(sparse)[k]));
        }
    }
    check(i == 0 && k == entries && worst < 1e-14, "the entries of the sparse matrix are those of the dense one");
    check(fabs(SM_ELEMENT_D(dense, 3, 4) - 1.5) < 1e-14, "an entry by hand: (I2 - I3) w3/I1");
    check(pc_cvode_jac(t, y, ydot, by_rows, &equations, NULL, NULL, NULL) == -1, "rows for columns are refused");

    for (i = 0; i < DIM; i++) {
        e[i] = 1.0 + i;
    }
    i = pc_cvode_jtimes(estimate, correction, t, y, ydot, &equations, NULL);
    for (worst = 0.0, j = 0; j < DIM; j++) {
        double sum = 0.0;
        for (k = 0; k < DIM; k++) {
            sum += SM_ELEMENT_D(dense, j, (sunindextype)k) * e[k];
        }
        worst = fmax(worst, fabs(sum - c[j]));
    }
    check(i == 0 && worst < 1e-13, "the product is that of the matrix");

    /* Projection to the unit sphere is radial, and removes the radial part of an error. */
    for (i = 0; i < DIM; i++) {
        state[i] *= i < 3 ? 1.001 : 1.0;
        e[i] = expected[i] = 1e-6 * (1.0 + i);
    }
    i = pc_cvode_proj(t, y, correction, 0.1, estimate, &equations);
    for (normal = dot(expected, state) / dot(state, state), worst = 0.0, j = 0; j < DIM; j++) {
        worst = fmax(worst, fabs(c[j] + (j < 3 ? state[j] / 1001.0 : 0.0)));
        worst = fmax(worst, fabs(e[j] - expected[j] + (j < 3 ? normal * state[j] : 0.0)));
    }
    /* The tolerance allows for e² and for rounding in e, a difference of numbers of order 1. */
    check(i == 0 && worst < 1e-11, "the projection, and that of the error estimate");

    /* A root at 0.25 of the area integral: 1.26 at the start, linear in the vertical. */
    equations.roots = &root;
    equations.roots_length = 1;
    i = pc_cvode_roots(t, y, &g, &equations);
    check(i == 0 && fabs(g - (1.001 * 1.26 - 0.25)) < 1e-14, "an observable less its value");
    root.observable = 99;
    check(pc_cvode_roots(t, y, &g, &equations) == -1, "an observable that there is not");

    check(pc_cvode_rhs(t, shorter, ydot, &equations) == -1, "a vector of another length");
    state[0] = NAN;
    i = pc_cvode_rhs(t, y, ydot, &equations);
    check(i == 1 && pc_error_status(equations.error) == PC_EVALUATION, "a state that is no number, with the reason");
    check(pc_cvode_proj(t, y, correction, 0.1, NULL, &equations) == 1, "which cannot be projected either");

    SUNMatDestroy(by_rows), SUNMatDestroy(sparse), SUNMatDestroy(dense);
    N_VDestroy(shorter), N_VDestroy(estimate), N_VDestroy(correction), N_VDestroy(ydot), N_VDestroy(y);
    SUNContext_Free(&context);
    pc_cvode_free(&equations);
    pc_system_free(top);
    pc_model_free(model);
    return wrong != 0;
}
