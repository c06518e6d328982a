/* A robot and the states at which the harness has computed every quantity by the library itself. */
#ifndef STATE_H
#define STATE_H

#include "check.h"

enum { MOST_INPUTS = 4, MOST_OUTPUTS = 4 };

/* The arguments of a quantity. */
struct arguments {
    const mozzi_model *model;
    mozzi_workspace *workspace;
    int32_t quantity;
    int by_columns; /* the order of the outputs' matrices */
    mozzi_frame frame;
    const mozzi_task *task;
    const double *about;
    const mozzi_environment *environment;
    size_t input_count, output_count;
    const double *in[MOST_INPUTS];
    size_t in_length[MOST_INPUTS];
    double *out[MOST_OUTPUTS];
    size_t out_length[MOST_OUTPUTS];
    size_t axes[MOST_OUTPUTS];
    size_t sizes[MOST_OUTPUTS][3];
    double *expected[MOST_OUTPUTS];
};

static inline mozzi_matrix matrix_of(const struct arguments *a, size_t k) {
    return a->by_columns ? mozzi_by_columns(a->out[k], a->sizes[k][0]) : mozzi_by_rows(a->out[k], a->sizes[k][1]);
}

static inline mozzi_tensor tensor_of(const struct arguments *a, size_t k) {
    mozzi_tensor tensor = mozzi_list_by_rows(a->out[k], a->sizes[k][1], a->sizes[k][2]);
    if (a->by_columns) {
        tensor.row_stride = 1;
        tensor.column_stride = (ptrdiff_t)a->sizes[k][1];
    }
    return tensor;
}

/* An output by rows, whatever its order: the caller frees it. */
static inline double *by_rows(const struct arguments *a, size_t k) {
    const size_t *sizes = a->sizes[k];
    const size_t blocks = a->axes[k] == 3 ? sizes[0] : 1;
    const size_t rows = a->axes[k] == 3 ? sizes[1] : a->axes[k] == 2 ? sizes[0] : 1;
    const size_t columns = a->axes[k] == 0 ? 1 : sizes[a->axes[k] - 1];
    double *numbers = (double *)malloc((a->out_length[k] + 1) * sizeof *numbers);
    size_t b, r, c;
    CHECK(numbers != NULL);
    for (b = 0; b < blocks; ++b) {
        for (r = 0; r < rows; ++r) {
            for (c = 0; c < columns; ++c) {
                const size_t from = a->by_columns && a->axes[k] > 1 ? c * rows + r : r * columns + c;
                numbers[(b * rows + r) * columns + c] = a->out[k][b * rows * columns + from];
            }
        }
    }
    return numbers;
}

static inline double *numbers_of(FILE *file, size_t count) {
    double *numbers = (double *)malloc((count + 1) * sizeof *numbers);
    size_t k;
    CHECK(numbers != NULL);
    for (k = 0; k < count; ++k) {
        CHECK(fscanf(file, "%lf", &numbers[k]) == 1);
    }
    return numbers;
}

/* A robot of the harness: its model, a workspace, and its quantities' arguments. */
struct robot {
    mozzi_model *model;
    mozzi_workspace *workspace;
    mozzi_frame frame;
    double gravity[3];
    mozzi_wrench wrench;
    mozzi_environment environment;
    size_t rows[6];
    mozzi_task task;
    double about[3];
    size_t count;
    struct arguments *quantities;
};

/* Reads the next robot; 0 at the end of the file. */
static inline int next_robot(FILE *file, struct robot *robot) {
    char name[64], frame[64], constraints[512];
    int floating;
    size_t q, k, rows;
    double *numbers;
    mozzi_load_options options = {0, 0, NULL, 0, NULL, 0};
    if (fscanf(file, "%63s %d %63s ", name, &floating, frame) != 3) {
        return 0;
    }
    CHECK(fgets(constraints, (int)sizeof constraints, file) != NULL);
    options.floating = floating;
    OK(mozzi_model_open(name, &options, &robot->model, NULL));
    if (constraints[0] == '{') {
        mozzi_model *tree = robot->model;
        OK(mozzi_model_with_constraints(tree, constraints, &robot->model));
        OK(mozzi_model_free(tree));
    }
    OK(mozzi_workspace_new(robot->model, &robot->workspace));
    OK(mozzi_model_frame(robot->model, frame, &robot->frame));
    OK(mozzi_model_environment(robot->model, &robot->environment));
    numbers = numbers_of(file, 3 + 6 + 6 + 6 + 3);
    memcpy(robot->environment.gravity, numbers, 3 * sizeof *numbers);
    memcpy(robot->environment.base_twist, numbers + 3, 6 * sizeof *numbers);
    memcpy(robot->environment.base_acceleration, numbers + 9, 6 * sizeof *numbers);
    robot->wrench.frame = robot->frame;
    memcpy(robot->wrench.F, numbers + 15, 6 * sizeof *numbers);
    memcpy(robot->about, numbers + 21, 3 * sizeof *numbers);
    free(numbers);
    robot->environment.wrenches = &robot->wrench;
    robot->environment.wrench_count = 1;
    CHECK(fscanf(file, "%zu", &rows) == 1);
    for (k = 0; k < rows; ++k) {
        CHECK(fscanf(file, "%zu", &robot->rows[k]) == 1);
    }
    robot->task.frame = robot->frame;
    robot->task.coordinates = MOZZI_SPACE;
    robot->task.rows = robot->rows;
    robot->task.row_count = rows;
    robot->count = mozzi_quantity_count();
    robot->quantities = (struct arguments *)calloc(robot->count, sizeof *robot->quantities);
    CHECK(robot->quantities != NULL);
    for (q = 0; q < robot->count; ++q) {
        struct arguments *a = &robot->quantities[q];
        const int32_t quantity = (int32_t)q;
        a->model = robot->model;
        a->workspace = robot->workspace;
        a->quantity = quantity;
        a->frame = robot->frame;
        a->task = &robot->task;
        a->about = robot->about;
        a->environment = &robot->environment;
        a->input_count = mozzi_quantity_input_count(quantity);
        a->output_count = mozzi_quantity_output_count(quantity);
        for (k = 0; k < a->input_count; ++k) {
            a->in_length[k] = mozzi_quantity_input_length(robot->model, quantity, k);
            a->in[k] = numbers_of(file, a->in_length[k]);
        }
        for (k = 0; k < a->output_count; ++k) {
            OK(mozzi_quantity_output_shape(robot->model, quantity, k, rows, &a->axes[k], a->sizes[k]));
            a->out_length[k] = a->sizes[k][0] * a->sizes[k][1] * a->sizes[k][2];
            a->expected[k] = numbers_of(file, a->out_length[k]);
            a->out[k] = (double *)malloc((a->out_length[k] + 1) * sizeof(double));
            CHECK(a->out[k] != NULL);
        }
    }
    return 1;
}

static inline void free_robot(struct robot *robot) {
    size_t q, k;
    for (q = 0; q < robot->count; ++q) {
        for (k = 0; k < robot->quantities[q].input_count; ++k) {
            free((void *)robot->quantities[q].in[k]);
        }
        for (k = 0; k < robot->quantities[q].output_count; ++k) {
            free(robot->quantities[q].out[k]);
            free(robot->quantities[q].expected[k]);
        }
    }
    free(robot->quantities);
    OK(mozzi_workspace_free(robot->workspace));
    OK(mozzi_model_free(robot->model));
}

static inline mozzi_subject subject_of(const struct arguments *a) {
    mozzi_subject subject;
    subject.task = *a->task;
    memcpy(subject.about, a->about, sizeof subject.about);
    return subject;
}

/* The same quantity by its number. */
static inline mozzi_status by_number(const struct arguments *a) {
    mozzi_input in[MOST_INPUTS];
    mozzi_output out[MOST_OUTPUTS];
    const mozzi_subject subject = subject_of(a);
    size_t k;
    for (k = 0; k < a->input_count; ++k) {
        in[k].data = a->in[k];
        in[k].length = a->in_length[k];
    }
    for (k = 0; k < a->output_count; ++k) {
        const mozzi_output zeros = {a->out[k], a->out_length[k], {0, 0, 0}};
        out[k] = zeros;
        if (a->axes[k] == 2 && a->by_columns) {
            out[k].strides[1] = 1;
            out[k].strides[2] = (ptrdiff_t)a->sizes[k][0];
        }
        if (a->axes[k] == 3 && a->by_columns) {
            const mozzi_tensor tensor = tensor_of(a, k);
            out[k].strides[0] = tensor.block_stride;
            out[k].strides[1] = tensor.row_stride;
            out[k].strides[2] = tensor.column_stride;
        }
    }
    return mozzi_compute(a->model, a->workspace, a->quantity, &subject, in, a->input_count, a->environment, out,
                         a->output_count);
}

static inline void clear(struct arguments *a) {
    size_t k, i;
    for (k = 0; k < a->output_count; ++k) {
        for (i = 0; i < a->out_length[k]; ++i) {
            a->out[k][i] = -1e300;
        }
    }
}

static inline void check_outputs(const struct arguments *a, double tolerance) {
    size_t k;
    for (k = 0; k < a->output_count; ++k) {
        double *found = by_rows(a, k);
        const double d = difference(found, a->expected[k], a->out_length[k]);
        if (!(d <= tolerance)) {
            fprintf(stderr, "%s of %s, output %zu: difference %g\n", mozzi_quantity_name(a->quantity),
                    mozzi_model_name(a->model), k, d);
            exit(1);
        }
        free(found);
    }
}

#endif
