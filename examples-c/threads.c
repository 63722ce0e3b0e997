/* One model on several threads: each has a system of the same code, with its own value of a
 * parameter, and a kernel. It integrates by the library and by Heun's method, and gives the numbers
 * of a single thread, to the last bit. The code is saved and loaded in between, as by a program that
 * derives its model once and for all. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "pc.h"

enum { DIM = 6, THREADS = 4, STEPS = 200 };

typedef struct {
    const pc_code *code; /* of all threads */
    double weight;
    double by_solver[DIM], by_kernel[DIM];
    int failed;
} task;

/* Advances y by h, by Heun's formula of order 2. */
static int step(pc_kernel *f, double t, double h, double *y)
{
    double k[DIM], l[DIM], moved[DIM];
    int i, failed = pc_kernel_rhs(t, y, k, f);
    for (i = 0; i < DIM; i++) {
        moved[i] = y[i] + h * k[i];
    }
    failed = failed || pc_kernel_rhs(t + h, moved, l, f);
    for (i = 0; i < DIM; i++) {
        y[i] += h / 2.0 * (k[i] + l[i]);
    }
    return failed;
}

static void *work(void *given)
{
    task *mine = given;
    pc_system *top = NULL; /* its own */
    pc_solver *solver = NULL;
    pc_kernel *kernel = NULL;
    pc_error *error = NULL;
    pc_solver_options options;
    int n;

    pc_solver_options_init(&options, sizeof options);
    options.method = PC_BDF; /* with the Jacobian, compiled when it is first evaluated */
    options.stop_time = 1.0; /* so the program pc steps, too */
    mine->failed = pc_system_of_code(mine->code, &top, &error) != PC_OK;
    n = (int)pc_system_parameter_count(top) - 1; /* the last, mg */
    mine->failed = mine->failed || pc_system_set_parameter(top, (size_t)n, mine->weight, &error) != PC_OK ||
                   pc_solver_new(top, &options, 0.0, NULL, 0, &solver, &error) != PC_OK ||
                   pc_solver_advance(solver, 1.0, mine->by_solver, DIM, &error) != PC_OK ||
                   pc_kernel_new(top, &kernel, &error) != PC_OK ||
                   pc_system_start(top, NULL, mine->by_kernel, DIM, &error) != PC_OK;
    for (n = 0; n < STEPS && !mine->failed; n++) {
        mine->failed = step(kernel, n / (double)STEPS, 1.0 / STEPS, mine->by_kernel);
    }
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    pc_error_free(error);
    pc_kernel_free(kernel);
    pc_solver_free(solver);
    pc_system_free(top);
    return NULL;
}

int main(void)
{
    static task alone[THREADS], together[THREADS];
    pthread_t threads[THREADS];
    pc_model *model = NULL;
    pc_code *derived = NULL, *code = NULL;
    pc_error *error = NULL;
    void *saved = NULL;
    size_t length;
    int i, j, differ = 0;

    if (pc_model_builtin("heavy-top-lagrange", &model, &error) != PC_OK ||
        pc_code_new(model, NULL, &derived, &error) != PC_OK ||
        pc_code_save(derived, &saved, &length, &error) != PC_OK ||
        pc_code_load(saved, length, &code, &error) != PC_OK) {
        fprintf(stderr, "%s\n", pc_error_message(error));
        return 1;
    }
    pc_bytes_free(saved);
    pc_model_free(model);
    for (i = 0; i < THREADS; i++) {
        alone[i].weight = together[i].weight = 1.0 + 0.5 * i;
        alone[i].code = derived;
        together[i].code = code;
        work(&alone[i]);
    }
    for (i = 0; i < THREADS; i++) {
        if (pthread_create(&threads[i], NULL, work, &together[i]) != 0) {
            return 1;
        }
    }
    for (i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        differ += alone[i].failed || together[i].failed ||
                  memcmp(alone[i].by_solver, together[i].by_solver, sizeof alone[i].by_solver) != 0 ||
                  memcmp(alone[i].by_kernel, together[i].by_kernel, sizeof alone[i].by_kernel) != 0;
        printf("pc run heavy-top-lagrange --set mg=%.1f --method bdf --t-end 1\nt = 1:", together[i].weight);
        for (j = 0; j < DIM; j++) {
            printf(" %.17g", together[i].by_solver[j]);
        }
        printf("\n");
    }
    pc_code_free(derived);
    pc_code_free(code);
    /* They had different weights, and so different motions. */
    differ += memcmp(alone[0].by_solver, alone[1].by_solver, sizeof alone[0].by_solver) == 0;
    printf("%s\n", differ ? "not the same" : "the same on one thread and on several");
    return differ != 0;
}
