/* Wrong arguments: each gives a status and a text, and changes nothing. */
#include "state.h"

#include "calls.inc"

/* Every quantity with every pointer missing, every number NaN or infinite, and handles of other models and kinds. */
static void quantities(struct robot *robot, mozzi_model *other, mozzi_workspace *of_other) {
    size_t q, k, i;
    mozzi_frame foreign;
    OK(mozzi_model_frame_at(other, 0, &foreign));
    for (q = 0; q < robot->count; ++q) {
        struct arguments *a = &robot->quantities[q];
        const struct arguments whole = *a;
        const double sentinel = 12345.0;
        double misaligned[2] = {0, 0};
        int is_of_frame;
        for (k = 0; k < a->output_count; ++k) {
            for (i = 0; i < a->out_length[k]; ++i) {
                a->out[k][i] = sentinel;
            }
        }
        a->model = NULL;
        EXPECT(MOZZI_NULL, typed[q](a));
        a->model = other;
        EXPECT(MOZZI_FOREIGN, typed[q](a));
        a->model = (const mozzi_model *)robot->workspace;
        EXPECT(MOZZI_INVALID_HANDLE, typed[q](a));
        *a = whole;
        a->workspace = NULL;
        EXPECT(MOZZI_NULL, typed[q](a));
        a->workspace = of_other;
        EXPECT(MOZZI_FOREIGN, typed[q](a));
        a->workspace = (mozzi_workspace *)robot->model;
        EXPECT(MOZZI_INVALID_HANDLE, typed[q](a));
        *a = whole;
        for (k = 0; k < a->input_count; ++k) {
            double *own = (double *)a->in[k];
            if (a->in_length[k] == 0) {
                continue;
            }
            a->in[k] = NULL;
            EXPECT(MOZZI_NULL, typed[q](a));
            a->in[k] = (const double *)((const char *)misaligned + 1);
            EXPECT(MOZZI_NULL, typed[q](a));
            a->in[k] = own;
            for (i = 0; i < a->in_length[k]; ++i) {
                const double number = own[i];
                own[i] = NAN;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                own[i] = INFINITY;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                own[i] = -INFINITY;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                own[i] = number;
            }
        }
        for (k = 0; k < a->output_count; ++k) {
            double *own = a->out[k];
            if (a->out_length[k] == 0) {
                continue;
            }
            a->out[k] = NULL;
            EXPECT(MOZZI_NULL, typed[q](a));
            a->out[k] = (double *)((char *)misaligned + 1);
            EXPECT(MOZZI_NULL, typed[q](a));
            a->out[k] = own;
        }
        /* frames and tasks */
        a->frame = foreign;
        is_of_frame = typed[q](a) == MOZZI_FOREIGN;
        a->frame = robot->frame + 1000;
        EXPECT(is_of_frame ? MOZZI_FOREIGN : MOZZI_OK, typed[q](a));
        a->frame = 0;
        EXPECT(is_of_frame ? MOZZI_FOREIGN : MOZZI_OK, typed[q](a));
        *a = whole;
        if (strcmp(mozzi_quantity_name((int32_t)q), "task_space_dynamics") == 0) {
            const size_t twice[2] = {1, 1}, beyond[1] = {6}, seven[7] = {0, 1, 2, 3, 4, 5, 0};
            mozzi_task task = *whole.task;
            a->task = NULL;
            EXPECT(MOZZI_NULL, typed[q](a));
            a->task = &task;
            task.frame = foreign;
            EXPECT(MOZZI_FOREIGN, typed[q](a));
            task = *whole.task;
            task.coordinates = 2;
            EXPECT(MOZZI_INVALID_ARGUMENT, typed[q](a));
            task = *whole.task;
            task.rows = NULL;
            EXPECT(MOZZI_NULL, typed[q](a));
            task.rows = twice;
            task.row_count = 2;
            EXPECT(MOZZI_INVALID_ARGUMENT, typed[q](a));
            task.rows = beyond;
            task.row_count = 1;
            EXPECT(MOZZI_INVALID_ARGUMENT, typed[q](a));
            task.rows = seven;
            task.row_count = 7;
            EXPECT(MOZZI_INVALID_ARGUMENT, typed[q](a));
            *a = whole;
        }
        /* environments, of those that depend on them */
        {
            mozzi_environment around = *whole.environment;
            mozzi_wrench wrench = robot->wrench;
            mozzi_status expected;
            around.wrenches = &wrench;
            a->environment = &around;
            around.gravity[1] = NAN;
            expected = typed[q](a);
            CHECK(expected == MOZZI_NOT_FINITE || expected == MOZZI_OK);
            if (expected != MOZZI_OK) {
                around = *whole.environment;
                around.base_twist[5] = INFINITY;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                around = *whole.environment;
                around.base_acceleration[0] = NAN;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                around = *whole.environment;
                around.wrenches = &wrench;
                wrench.F[3] = NAN;
                EXPECT(MOZZI_NOT_FINITE, typed[q](a));
                wrench = robot->wrench;
                wrench.frame = foreign;
                EXPECT(MOZZI_FOREIGN, typed[q](a));
                around.wrenches = NULL;
                EXPECT(MOZZI_NULL, typed[q](a));
                around.wrenches = &wrench;
                around.wrench_count = 100000;
                EXPECT(MOZZI_INVALID_ARGUMENT, typed[q](a));
            }
            *a = whole;
        }
        /* by number, with wrong lengths and counts */
        {
            mozzi_input in[MOST_INPUTS];
            mozzi_output out[MOST_OUTPUTS];
            mozzi_subject subject = subject_of(a);
            const int32_t quantity = (int32_t)q;
            for (k = 0; k < a->input_count; ++k) {
                in[k].data = a->in[k];
                in[k].length = a->in_length[k];
            }
            for (k = 0; k < a->output_count; ++k) {
                const mozzi_output zeros = {a->out[k], a->out_length[k], {0, 0, 0}};
                out[k] = zeros;
            }
#define COMPUTE(inputs, outputs)                                                                        \
    mozzi_compute(a->model, a->workspace, quantity, &subject, in, inputs, a->environment, out, outputs)
            OK(COMPUTE(a->input_count, a->output_count));
            EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(a->input_count + 1, a->output_count));
            EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(0, a->output_count));
            EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(a->input_count, a->output_count + 1));
            EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(a->input_count, 0));
            for (k = 0; k < a->input_count; ++k) {
                in[k].length += 1;
                EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(a->input_count, a->output_count));
                in[k].length -= 1;
            }
            for (k = 0; k < a->output_count; ++k) {
                out[k].length += 1;
                EXPECT(MOZZI_WRONG_LENGTH, COMPUTE(a->input_count, a->output_count));
                out[k].length -= 1;
            }
            EXPECT(MOZZI_NULL, mozzi_compute(a->model, a->workspace, quantity, &subject, NULL, a->input_count,
                                             a->environment, out, a->output_count));
            EXPECT(MOZZI_NULL, mozzi_compute(a->model, a->workspace, quantity, &subject, in, a->input_count,
                                             a->environment, NULL, a->output_count));
            EXPECT(MOZZI_NOT_FOUND, mozzi_compute(a->model, a->workspace, -1, &subject, in, a->input_count,
                                                  a->environment, out, a->output_count));
            EXPECT(MOZZI_NOT_FOUND, mozzi_compute(a->model, a->workspace, 1 << 30, &subject, in, a->input_count,
                                                  a->environment, out, a->output_count));
        }
    }
}

static void handles(mozzi_model *model) {
    mozzi_model *none = model;
    mozzi_workspace *workspace = NULL;
    mozzi_diagnostics *diagnostics = NULL;
    mozzi_frame frame = 0;
    const uint64_t foreign[4] = {1, 2, 3, 4};
    const char *missing = "no such robot";
    OK(mozzi_model_free(NULL));
    OK(mozzi_workspace_free(NULL));
    OK(mozzi_program_free(NULL));
    OK(mozzi_batch_free(NULL));
    OK(mozzi_inverse_kinematics_free(NULL));
    OK(mozzi_diagnostics_free(NULL));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_model_free((mozzi_model *)foreign));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_workspace_free((mozzi_workspace *)model));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_program_free((mozzi_program *)model));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_batch_free((mozzi_batch *)model));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_inverse_kinematics_free((mozzi_inverse_kinematics *)model));
    EXPECT(MOZZI_INVALID_HANDLE, mozzi_diagnostics_free((mozzi_diagnostics *)model));
    EXPECT(MOZZI_NULL, mozzi_model_free((mozzi_model *)((char *)model + 1)));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_open(missing, NULL, &none, &diagnostics));
    CHECK(none == NULL);
    CHECK(diagnostics != NULL && mozzi_diagnostics_count(diagnostics) == 0);
    OK(mozzi_diagnostics_free(diagnostics));
    EXPECT(MOZZI_NULL, mozzi_model_open(NULL, NULL, &none, NULL));
    EXPECT(MOZZI_NULL, mozzi_model_open("ur5", NULL, NULL, NULL));
    EXPECT(MOZZI_NO_FILE, mozzi_model_load("/no/such/file.urdf", NULL, &none, NULL));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_model_open("\xff\xfe", NULL, &none, NULL));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_embedded(missing, &none));
    EXPECT(MOZZI_NULL, mozzi_model_parse("x", NULL, 5, NULL, &none, NULL));
    EXPECT(MOZZI_REFUSED, mozzi_model_parse("x", "", 0, NULL, &none, NULL));
    EXPECT(MOZZI_NULL, mozzi_model_copy(NULL, &none));
    EXPECT(MOZZI_NULL, mozzi_workspace_new(model, NULL));
    EXPECT(MOZZI_NULL, mozzi_workspace_new(NULL, &workspace));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_frame(model, "no such frame", &frame));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_frame_at(model, 100000, &frame));
    EXPECT(MOZZI_NULL, mozzi_model_frame(model, NULL, &frame));
    EXPECT(MOZZI_NULL, mozzi_model_end_effector(model, NULL));
    CHECK(mozzi_model_n(NULL) == 0 && mozzi_model_name(NULL) == NULL && isnan(mozzi_model_mass(NULL)));
    CHECK(mozzi_model_joint_name(model, 100000) == NULL && mozzi_model_joint_name(NULL, 0) == NULL);
    CHECK(mozzi_quantity_name(-1) == NULL && mozzi_quantity_name(1 << 30) == NULL);
    CHECK(mozzi_quantity_input_count(-1) == 0 && mozzi_quantity_input_length(model, 0, 100) == 0);
    CHECK(mozzi_embedded_name(100) == NULL && mozzi_diagnostics_text(NULL) == NULL);
    CHECK(strcmp(mozzi_status_text(-5), "not a status") == 0);
    {
        mozzi_load_options options = {7, 0, NULL, 0, NULL, 0};
        int32_t quantity;
        size_t axes, sizes[3];
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_model_open("ur5", &options, &none, NULL));
        options.policy = 0;
        options.xacro_argument_count = 1;
        EXPECT(MOZZI_NULL, mozzi_model_open("ur5", &options, &none, NULL));
        EXPECT(MOZZI_NOT_FOUND, mozzi_quantity_named("no such quantity", &quantity));
        EXPECT(MOZZI_NOT_FOUND, mozzi_quantity_output_shape(model, 0, 5, 0, &axes, sizes));
        EXPECT(MOZZI_NOT_FOUND, mozzi_quantity_output_shape(model, -3, 0, 0, &axes, sizes));
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_quantity_output_shape(model, 0, 0, 9, &axes, sizes));
        EXPECT(MOZZI_NULL, mozzi_quantity_output_shape(model, 0, 0, 0, NULL, sizes));
    }
}

static void edits(mozzi_model *model, mozzi_model *other) {
    mozzi_model *edited = model;
    mozzi_frame frame, foreign;
    const double nan_10[10] = {1, 0, 0, NAN, 1, 0, 0, 1, 0, 1}, T[16] = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double one = 1.0, not_finite = NAN;
    const char *joint = mozzi_model_joint_name(model, 0), *none = "no such joint";
    OK(mozzi_model_frame_at(model, 0, &frame));
    OK(mozzi_model_frame_at(other, 0, &foreign));
    EXPECT(MOZZI_NOT_FINITE, mozzi_model_with_payload(model, frame, nan_10, &edited));
    CHECK(edited == NULL);
    EXPECT(MOZZI_FOREIGN, mozzi_model_with_payload(model, foreign, T, &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_payload(model, frame, NULL, &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_payload(model, frame, T, NULL));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_with_locked_joints(model, &none, &one, 1, &edited));
    EXPECT(MOZZI_NOT_FINITE, mozzi_model_with_locked_joints(model, &joint, &not_finite, 1, &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_locked_joints(model, NULL, &one, 1, &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_locked_joints(model, &joint, NULL, 1, &edited));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_model_with_frame(model, "tool", frame, T, &edited));
    EXPECT(MOZZI_FOREIGN, mozzi_model_with_end_effector(model, foreign, &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_gravity(model, NULL, &edited));
    EXPECT(MOZZI_NOT_FINITE, mozzi_model_with_gravity(model, nan_10 + 3, &edited));
    EXPECT(MOZZI_REFUSED, mozzi_model_with_constraints(model, "{", &edited));
    EXPECT(MOZZI_NULL, mozzi_model_with_constraints(model, NULL, &edited));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_with_start(model, "no such state", &edited));
    EXPECT(MOZZI_NOT_FOUND, mozzi_model_state(model, "no such state", NULL, NULL, NULL));
}

static void many(mozzi_model *model, mozzi_model *other) {
    const size_t n = mozzi_model_n(model), states = 3;
    double *theta = calloc(states * n, sizeof *theta), *out = calloc(states * n, sizeof *out);
    double *tau = calloc(states * n, sizeof *tau);
    mozzi_batch *batch = NULL;
    mozzi_table in;
    mozzi_table_out result;
    mozzi_batch_environment around = {NULL, NULL, NULL, NULL, 0};
    mozzi_batch_wrench wrench;
    CHECK(theta != NULL && out != NULL && tau != NULL);
    EXPECT(MOZZI_NULL, mozzi_batch_new(NULL, 1, &batch));
    EXPECT(MOZZI_NULL, mozzi_batch_new(model, 1, NULL));
    EXPECT(MOZZI_NULL, mozzi_batch_kernels_only(NULL, 1, &batch));
    OK(mozzi_batch_new(model, 1, &batch));
    in.data = theta;
    in.length = states * n;
    result.data = out;
    result.length = states * n;
#define BATCH(quantity, count) mozzi_batch_compute(batch, quantity, NULL, states, &in, count, &around, &result, count)
    OK(BATCH(MOZZI_GRAVITY_FORCES, 1));
    EXPECT(MOZZI_WRONG_LENGTH, BATCH(MOZZI_GRAVITY_FORCES, 0));
    EXPECT(MOZZI_NOT_FOUND, BATCH(-1, 1));
    EXPECT(MOZZI_FOREIGN, BATCH(MOZZI_FORWARD_KINEMATICS, 1));
    in.length -= 1;
    EXPECT(MOZZI_WRONG_LENGTH, BATCH(MOZZI_GRAVITY_FORCES, 1));
    in.length += 1;
    result.length -= 1;
    EXPECT(MOZZI_WRONG_LENGTH, BATCH(MOZZI_GRAVITY_FORCES, 1));
    result.length += 1;
    in.data = NULL;
    EXPECT(MOZZI_NULL, BATCH(MOZZI_GRAVITY_FORCES, 1));
    in.data = theta;
    result.data = theta + 1;
    EXPECT(MOZZI_INVALID_ARGUMENT, BATCH(MOZZI_GRAVITY_FORCES, 1));
    result.data = out;
    theta[2] = NAN;
    EXPECT(MOZZI_NOT_FINITE, BATCH(MOZZI_GRAVITY_FORCES, 1));
    EXPECT(MOZZI_NOT_FINITE, mozzi_batch_simulate(batch, states, theta, out, tau, NULL, 0, 1, 1));
    theta[2] = 0;
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_compute(batch, MOZZI_GRAVITY_FORCES, NULL, (size_t)-1, &in, 1, &around, &result, 1));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, (size_t)-1, theta, out, tau, NULL, 0, 1, 1));
    {
        double *each = calloc(states * (n + 6), sizeof *each);
        CHECK(each != NULL);
        each[4] = NAN;
        around.gravity_of_each = each;
        EXPECT(MOZZI_NOT_FINITE, BATCH(MOZZI_GRAVITY_FORCES, 1));
        around.gravity_of_each = NULL;
        OK(mozzi_model_frame_at(model, 0, &wrench.frame));
        wrench.F = each;
        around.wrenches = &wrench;
        around.wrench_count = 1;
        EXPECT(MOZZI_NOT_FINITE, BATCH(MOZZI_GRAVITY_FORCES, 1));
        each[4] = 0;
        result.data = each + 1;
        EXPECT(MOZZI_INVALID_ARGUMENT, BATCH(MOZZI_GRAVITY_FORCES, 1));
        result.data = out;
        OK(mozzi_batch_simulate(batch, states, theta, out, tau, &around, 0, 1, 1));
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, out, out, &around, 0, 1, 1));
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, theta, tau, &around, 0, 1, 1));
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, each, tau, &around, 0, 1, 1));
        memset(theta, 0, states * n * sizeof *theta);
        memset(out, 0, states * n * sizeof *out);
        free(each);
    }
    OK(mozzi_model_frame_at(other, 0, &wrench.frame));
    wrench.F = out;
    around.wrenches = &wrench;
    around.wrench_count = 1;
    EXPECT(MOZZI_FOREIGN, BATCH(MOZZI_GRAVITY_FORCES, 1));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, out, tau, NULL, 77, 1, 1));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, out, tau, NULL, 0, 1, 0));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, out, tau, NULL, MOZZI_MIDPOINT, 1, 1));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_batch_simulate(batch, states, theta, out, tau, NULL, 0, -1, 1));
    OK(mozzi_batch_free(batch));
    free(tau);
    free(theta);
    free(out);
}

static int32_t bad_torque(void *user, double t, const double *theta, const double *dtheta, double *tau) {
    (void)user, (void)theta, (void)dtheta, (void)tau;
    return t > 0.5;
}

static void motions(mozzi_model *model, mozzi_model *other) {
    const size_t n = mozzi_model_n(model);
    double *theta = calloc(n, sizeof *theta), *dtheta = calloc(n, sizeof *dtheta);
    double T[16] = {1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const int32_t quantity = MOZZI_FORWARD_DYNAMICS, bad = 1000;
    mozzi_simulation_options options;
    mozzi_inverse_kinematics_options search;
    mozzi_inverse_kinematics *solver = NULL;
    mozzi_program *program = NULL;
    mozzi_frame frame, foreign;
    CHECK(theta != NULL && dtheta != NULL);
#define SIMULATE(program) mozzi_simulate(model, program, &options, theta, dtheta, NULL, NULL, NULL, NULL)
    EXPECT(MOZZI_NULL, mozzi_simulation_defaults(1, 10, NULL));
    OK(mozzi_simulation_defaults(1, 10, &options));
    OK(SIMULATE(NULL));
    EXPECT(MOZZI_NULL, mozzi_simulate(model, NULL, NULL, theta, dtheta, NULL, NULL, NULL, NULL));
    EXPECT(MOZZI_CALLBACK, mozzi_simulate(model, NULL, &options, theta, dtheta, bad_torque, NULL, NULL, NULL));
    options.steps = 0;
    EXPECT(MOZZI_INVALID_ARGUMENT, SIMULATE(NULL));
    options.steps = 10;
    options.method = -1;
    EXPECT(MOZZI_INVALID_ARGUMENT, SIMULATE(NULL));
    options.method = 0;
    options.joint_limits = 3;
    EXPECT(MOZZI_INVALID_ARGUMENT, SIMULATE(NULL));
    options.joint_limits = 0;
    options.duration = NAN;
    EXPECT(MOZZI_INVALID_ARGUMENT, SIMULATE(NULL));
    options.duration = 1;
    dtheta[0] = NAN;
    EXPECT(MOZZI_NOT_FINITE, SIMULATE(NULL));
    dtheta[0] = 0;
    OK(mozzi_program_new(other, &quantity, NULL, 1, &program));
    EXPECT(MOZZI_FOREIGN, SIMULATE(program));
    OK(mozzi_program_free(program));
    EXPECT(MOZZI_NOT_FOUND, mozzi_program_new(model, &bad, NULL, 1, &program));
    EXPECT(MOZZI_NULL, mozzi_program_new(model, NULL, NULL, 1, &program));

    OK(mozzi_model_end_effector(model, &frame));
    OK(mozzi_model_frame_at(other, 0, &foreign));
    OK(mozzi_inverse_kinematics_defaults(&search));
    EXPECT(MOZZI_FOREIGN, mozzi_inverse_kinematics_new(model, foreign, NULL, &solver));
    search.method = 5;
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_inverse_kinematics_new(model, frame, &search, &solver));
    search.method = 0;
    search.angle = NAN;
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_inverse_kinematics_new(model, frame, &search, &solver));
    search.angle = 1e-8;
    search.starts = 2;
    OK(mozzi_inverse_kinematics_new(model, frame, &search, &solver));
#define SOLVE(kind) mozzi_inverse_kinematics_solve(solver, kind, T, theta, NULL, theta, NULL)
    EXPECT(MOZZI_NOT_REACHED, SOLVE(MOZZI_GOAL_POSE));
    EXPECT(MOZZI_INVALID_ARGUMENT, SOLVE(9));
    T[0] = 2;
    EXPECT(MOZZI_INVALID_ARGUMENT, SOLVE(MOZZI_GOAL_POSE));
    EXPECT(MOZZI_NULL, mozzi_inverse_kinematics_solve(solver, 0, NULL, theta, NULL, theta, NULL));
    theta[1] = NAN;
    EXPECT(MOZZI_NOT_FINITE, SOLVE(MOZZI_GOAL_POSITION));
    theta[1] = 0;
    OK(mozzi_inverse_kinematics_free(solver));
    EXPECT(MOZZI_NULL, mozzi_integrate(model, NULL, dtheta, 1));
    EXPECT(MOZZI_NOT_FINITE, mozzi_integrate(model, theta, dtheta, INFINITY));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_integrate(model, theta, theta, 1));
    EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_difference(model, theta, dtheta, dtheta));
    EXPECT(MOZZI_NULL, mozzi_difference(model, theta, NULL, dtheta));
    free(theta);
    free(dtheta);
}

/* A robot whose mass matrix is singular: the outputs are NaN. */
static void singular(void) {
    static const char text[] =
        "<robot name='massless'><link name='base'/><link name='ghost'/><joint name='hinge' type='continuous'>"
        "<parent link='base'/><child link='ghost'/><axis xyz='0 0 1'/></joint></robot>";
    mozzi_model *model = NULL;
    mozzi_workspace *workspace = NULL;
    const double zero = 0;
    double found = 1;
    OK(mozzi_model_parse("massless", text, strlen(text), NULL, &model, NULL));
    OK(mozzi_workspace_new(model, &workspace));
    EXPECT(MOZZI_SINGULAR, mozzi_forward_dynamics(model, workspace, &zero, &zero, &zero, NULL, &found));
    CHECK(isnan(found) && strstr(mozzi_last_error(), "hinge") != NULL);
    OK(mozzi_inverse_dynamics(model, workspace, &zero, &zero, &zero, NULL, &found));
    CHECK(found == 0);
    {
        double c[3];
        EXPECT(MOZZI_INVALID_ARGUMENT, mozzi_center_of_mass(model, workspace, &zero, c));
    }
    OK(mozzi_workspace_free(workspace));
    OK(mozzi_model_free(model));
}

int main(int count, char **arguments) {
    FILE *file;
    struct robot robot;
    mozzi_model *other = NULL, *ur5 = NULL;
    mozzi_workspace *of_other = NULL;
    CHECK(count == 2);
    CHECK(strcmp(mozzi_last_error(), "") == 0);
    OK(mozzi_model_embedded("double_pendulum", &other));
    OK(mozzi_model_embedded("ur5", &ur5));
    OK(mozzi_workspace_new(other, &of_other));
    file = fopen(arguments[1], "r");
    CHECK(file != NULL);
    while (next_robot(file, &robot)) {
        quantities(&robot, other, of_other);
        if (mozzi_model_is_floating(robot.model)) {
            struct arguments *a = &robot.quantities[MOZZI_MASS_MATRIX];
            double *theta = (double *)a->in[0];
            theta[0] += 0.5;
            EXPECT(MOZZI_INVALID_ARGUMENT, typed[MOZZI_MASS_MATRIX](a));
        }
        handles(robot.model);
        free_robot(&robot);
    }
    fclose(file);
    edits(ur5, other);
    many(ur5, other);
    motions(ur5, other);
    singular();
    OK(mozzi_workspace_free(of_other));
    OK(mozzi_model_free(other));
    OK(mozzi_model_free(ur5));
    return 0;
}
