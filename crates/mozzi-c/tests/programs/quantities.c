/* Every quantity by its typed function and by its number, by rows and by columns, by the kernels and by machine code,
 * and into its own inputs, against the library itself. */
#include "state.h"

#include "calls.inc"

/* `inverse_dynamics`, `forward_dynamics` and the like: the output lies on an input. */
static void in_place(struct arguments *a) {
    size_t i, k;
    for (i = 0; i < a->input_count; ++i) {
        for (k = 0; k < a->output_count; ++k) {
            if (a->axes[k] == 1 && a->out_length[k] == a->in_length[i]) {
                double *own = a->out[k];
                const double *input = a->in[i];
                double *both = malloc((a->in_length[i] + 1) * sizeof *both);
                CHECK(both != NULL);
                memcpy(both, input, a->in_length[i] * sizeof *both);
                a->in[i] = both;
                a->out[k] = both;
                OK(typed[a->quantity](a));
                check_outputs(a, 1e-10);
                a->in[i] = input;
                a->out[k] = own;
                free(both);
            }
        }
    }
}

int main(int count, char **arguments) {
    FILE *file;
    struct robot robot;
    int robots = 0, with_code = 0;
    CHECK(count == 2);
    CHECK(strcmp(mozzi_version(), MOZZI_VERSION) == 0);
    CHECK(mozzi_abi_version() == MOZZI_ABI_VERSION);
    CHECK(sizeof typed / sizeof *typed == mozzi_quantity_count());
    file = fopen(arguments[1], "r");
    CHECK(file != NULL);
    while (next_robot(file, &robot)) {
        size_t q;
        int order;
        for (q = 0; q < robot.count; ++q) {
            struct arguments *a = &robot.quantities[q];
            int32_t named = -1;
            OK(mozzi_quantity_named(mozzi_quantity_name((int32_t)q), &named));
            CHECK(named == (int32_t)q);
            CHECK(strlen(mozzi_quantity_formula((int32_t)q)) > 0);
            for (order = 0; order < 2; ++order) {
                a->by_columns = order;
                clear(a);
                OK(typed[q](a));
                check_outputs(a, 1e-10);
                clear(a);
                OK(by_number(a));
                check_outputs(a, 1e-10);
            }
            a->by_columns = 0;
            in_place(a);
        }
        /* machine code, in the robot's own environment: against the kernels in it */
        for (q = 0; q < robot.count; ++q) {
            struct arguments *a = &robot.quantities[q];
            const mozzi_subject subject = subject_of(a);
            const int32_t quantity = (int32_t)q;
            mozzi_program *program = NULL;
            size_t k;
            a->environment = NULL;
            OK(typed[q](a));
            for (k = 0; k < a->output_count; ++k) {
                memcpy(a->expected[k], a->out[k], a->out_length[k] * sizeof(double));
            }
            OK(mozzi_program_new(robot.model, &quantity, &subject, 1, &program));
            with_code += mozzi_program_has_code(program, quantity, &subject);
            OK(mozzi_workspace_with_program(program, &a->workspace));
            OK(mozzi_program_free(program));
            clear(a);
            OK(typed[q](a));
            check_outputs(a, 1e-9);
            OK(mozzi_workspace_free(a->workspace));
        }
        free_robot(&robot);
        ++robots;
    }
    fclose(file);
    CHECK(robots > 2);
    printf("%d robots, %d with machine code\n", robots, with_code);
    return 0;
}
