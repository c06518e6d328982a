/* Loading, diagnostics, properties, edits, constraints, states, batches, simulation, inverse kinematics. */
#include "check.h"

static mozzi_model *embedded(const char *name) {
    mozzi_model *model = NULL;
    OK(mozzi_model_embedded(name, &model));
    return model;
}

static void loading(void) {
    static const char wrong[] = "<robot name='arm'><link name='a'><intertial/></link></robot>";
    static const char odd[] =
        "<robot name='arm'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' "
        "iyy='1' iyz='0' izz='1'/></inertial></link><joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
        "<axis xyz='0 0 1'/></joint></robot>";
    static const char xacro[] =
        "<robot name='arm' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arg name='m' default='1'/><link name='a'/>"
        "<link name='b'><inertial><mass value='$(arg m)'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
        "</inertial></link><joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>"
        "</joint></robot>";
    mozzi_model *model = NULL;
    mozzi_diagnostics *diagnostics = NULL;
    mozzi_diagnostic found;
    mozzi_load_options options = {0, 0, NULL, 0, NULL, 0};
    mozzi_pair mass = {"m", "2.5"};
    EXPECT(MOZZI_REFUSED, mozzi_model_parse("arm.urdf", wrong, strlen(wrong), NULL, &model, &diagnostics));
    CHECK(model == NULL && mozzi_diagnostics_count(diagnostics) == 1);
    OK(mozzi_diagnostics_get(diagnostics, 0, &found));
    CHECK(found.is_error == 1 && found.line == 1 && found.column == 35);
    CHECK(strcmp(found.file, "arm.urdf") == 0 && strcmp(found.calls, "") == 0);
    CHECK(strstr(found.message, "<intertial>") != NULL && strncmp(found.code, "mozzi::urdf::", 13) == 0);
    CHECK(strncmp(found.text, "arm.urdf:1:35: error: ", 22) == 0);
    CHECK(strncmp(mozzi_diagnostics_text(diagnostics), "arm.urdf is refused: 1 error\n", 29) == 0);
    CHECK(strcmp(mozzi_diagnostics_text(diagnostics), mozzi_last_error()) == 0);
    EXPECT(MOZZI_NOT_FOUND, mozzi_diagnostics_get(diagnostics, 1, &found));
    OK(mozzi_diagnostics_free(diagnostics));

    OK(mozzi_model_parse("odd.urdf", odd, strlen(odd), NULL, &model, &diagnostics));
    CHECK(mozzi_diagnostics_count(diagnostics) >= 1);
    OK(mozzi_diagnostics_get(diagnostics, 0, &found));
    CHECK(found.is_error == 0 && found.consequence == MOZZI_CONSEQUENCE_REMARK);
    OK(mozzi_diagnostics_free(diagnostics));
    OK(mozzi_model_free(model));
    options.policy = MOZZI_POLICY_STRICT;
    EXPECT(MOZZI_REFUSED, mozzi_model_parse("odd.urdf", odd, strlen(odd), &options, &model, NULL));

    options.policy = MOZZI_POLICY_DEFAULT;
    options.xacro_arguments = &mass;
    options.xacro_argument_count = 1;
    options.floating = 1;
    OK(mozzi_model_parse("arm.urdf.xacro", xacro, strlen(xacro), &options, &model, NULL));
    CHECK(mozzi_model_mass(model) == 2.5 && mozzi_model_n(model) == 7 && mozzi_model_is_floating(model) == 1);
    OK(mozzi_model_free(model));
    {
        size_t k, count = mozzi_embedded_count();
        CHECK(count > 3);
        for (k = 0; k < count; ++k) {
            OK(mozzi_model_free(embedded(mozzi_embedded_name(k))));
        }
    }
}

static void properties(void) {
    mozzi_model *model = embedded("panda"), *copy = NULL;
    const size_t n = mozzi_model_n(model), joints = mozzi_model_joint_count(model);
    double lower[16], upper[16], velocity[16], effort[16], gravity[3], theta[16], dtheta[16], time = 1;
    uint8_t driven[16];
    size_t k, q, positions, j, velocities;
    mozzi_frame frame, by_number;
    CHECK(strcmp(mozzi_model_name(model), "panda") == 0);
    CHECK(joints == n && mozzi_model_nq(model) == n && mozzi_model_constraint_rows(model) == 0);
    CHECK(mozzi_model_parameter_count(model) == 10 * mozzi_model_body_count(model) + 5 * joints);
    CHECK(strcmp(mozzi_model_joint_name(model, 0), "panda_joint1") == 0);
    CHECK(strcmp(mozzi_model_position_name(model, 1), "panda_joint2") == 0);
    CHECK(strcmp(mozzi_model_velocity_name(model, 1), "panda_joint2") == 0);
    CHECK(strstr(mozzi_model_parameter_name(model, 0), ".m") != NULL);
    OK(mozzi_model_limits(model, lower, upper, velocity, effort));
    for (k = 0; k < joints; ++k) {
        CHECK(lower[k] < upper[k] && velocity[k] > 0 && effort[k] > 0);
        OK(mozzi_model_joint_place(model, k, &q, &positions, &j, &velocities));
        CHECK(q == k && j == k && positions == 1 && velocities == 1);
    }
    OK(mozzi_model_motors(model, driven));
    CHECK(driven[0] == 1 && driven[n - 1] == 1);
    OK(mozzi_model_gravity(model, gravity));
    CHECK(gravity[0] == 0 && gravity[2] == -9.81);
    OK(mozzi_model_start(model, theta, dtheta, &time));
    CHECK(time == 0 && dtheta[0] == 0);
    OK(mozzi_model_frame(model, "panda_hand", &frame));
    OK(mozzi_model_frame_at(model, MOZZI_FRAME_NUMBER(frame), &by_number));
    CHECK(frame == by_number);
    CHECK(strcmp(mozzi_model_frame_name(model, MOZZI_FRAME_NUMBER(frame)), "panda_hand") == 0);
    OK(mozzi_model_copy(model, &copy));
    OK(mozzi_model_free(model));
    CHECK(mozzi_model_n(copy) == n);
    OK(mozzi_model_frame_at(copy, 0, &by_number));
    CHECK(frame >> 32 == by_number >> 32); /* frames of the copy are the model's */
    OK(mozzi_model_free(copy));
}

/* g by a workspace of this model. */
static void gravity_forces(const mozzi_model *model, const double *theta, double *g) {
    mozzi_workspace *workspace = NULL;
    OK(mozzi_workspace_new(model, &workspace));
    OK(mozzi_gravity_forces(model, workspace, theta, NULL, g));
    OK(mozzi_workspace_free(workspace));
}

/* T by a workspace of this model. */
static void pose_of(const mozzi_model *model, const double *theta, mozzi_frame frame, double *T) {
    mozzi_workspace *workspace = NULL;
    OK(mozzi_workspace_new(model, &workspace));
    OK(mozzi_forward_kinematics(model, workspace, theta, frame, mozzi_by_rows(T, 4)));
    OK(mozzi_workspace_free(workspace));
}

static void edits(void) {
    mozzi_model *model = embedded("ur5"), *edited = NULL, *further = NULL;
    const double theta[6] = {0.3, -1.2, 1.5, 0.3, 1.1, 0.2};
    double g[6], h[6], J[36], T[16], T_tool[16];
    size_t k;
    mozzi_frame tip, tool;
    mozzi_workspace *workspace = NULL;
    OK(mozzi_model_end_effector(model, &tip));
    gravity_forces(model, theta, g);
    {
        /* a payload of 2 kg at (0, 0, 0.1) m weighs as much as a wrench that pushes down with 2 · 9.81 N there */
        const double payload[10] = {2, 0, 0, 0.2, 0.02, 0, 0, 0.02, 0, 0};
        double force[3], moment[3], tau;
        OK(mozzi_model_with_payload(model, tip, payload, &edited));
        gravity_forces(edited, theta, h);
        CHECK(fabs(mozzi_model_mass(edited) - mozzi_model_mass(model) - 2) < 1e-12);
        OK(mozzi_workspace_new(model, &workspace));
        OK(mozzi_forward_kinematics(model, workspace, theta, tip, mozzi_by_rows(T, 4)));
        OK(mozzi_body_jacobian(model, workspace, theta, tip, mozzi_by_rows(J, 6)));
        OK(mozzi_workspace_free(workspace));
        for (k = 0; k < 3; ++k) {
            force[k] = -2 * -9.81 * T[8 + k]; /* −m Rᵀg, as the robot holds it */
        }
        moment[0] = -0.1 * force[1];
        moment[1] = 0.1 * force[0];
        moment[2] = 0;
        for (k = 0; k < 6; ++k) {
            tau = 0;
            tau += J[k] * moment[0] + J[6 + k] * moment[1] + J[12 + k] * moment[2];
            tau += J[18 + k] * force[0] + J[24 + k] * force[1] + J[30 + k] * force[2];
            CHECK(fabs(h[k] - g[k] - tau) < 1e-10);
        }
        OK(mozzi_model_free(edited));
    }
    {
        const char *const joints[2] = {"shoulder_pan_joint", "wrist_3_joint"};
        const double positions[2] = {0.3, 0.2};
        double part[4];
        OK(mozzi_model_with_locked_joints(model, joints, positions, 2, &edited));
        CHECK(mozzi_model_n(edited) == 4);
        gravity_forces(edited, theta + 1, part);
        CHECK(difference(part, g + 1, 4) < 1e-12);
        OK(mozzi_model_free(edited));
    }
    {
        const double at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1, 0, 0, 0, 1};
        OK(mozzi_model_with_frame(model, "tool", tip, at, &edited));
        OK(mozzi_model_frame(edited, "tool", &tool));
        pose_of(edited, theta, tool, T_tool);
        for (k = 0; k < 3; ++k) {
            CHECK(fabs(T_tool[4 * k + 3] - T[4 * k + 3] - 0.1 * T[4 * k + 2]) < 1e-14);
        }
        OK(mozzi_model_with_end_effector(edited, tool, &further));
        OK(mozzi_model_end_effector(further, &tip));
        CHECK(MOZZI_FRAME_NUMBER(tip) == MOZZI_FRAME_NUMBER(tool));
        OK(mozzi_model_free(further));
        OK(mozzi_model_free(edited));
    }
    {
        const double moon[3] = {0, 0, -1.62};
        OK(mozzi_model_with_gravity(model, moon, &edited));
        gravity_forces(edited, theta, h);
        for (k = 0; k < 6; ++k) {
            CHECK(fabs(h[k] - g[k] * 1.62 / 9.81) < 1e-12);
        }
        OK(mozzi_model_free(edited));
    }
    {
        double parameters[200];
        const size_t p = mozzi_model_parameter_count(model);
        CHECK(p <= 200);
        OK(mozzi_model_parameters(model, parameters));
        for (k = 0; k < p; ++k) {
            parameters[k] *= 2;
        }
        OK(mozzi_model_with_parameters(model, parameters, &edited));
        gravity_forces(edited, theta, h);
        for (k = 0; k < 6; ++k) {
            CHECK(fabs(h[k] - 2 * g[k]) < 1e-11);
        }
        OK(mozzi_model_free(edited));
    }
    {
        double found[6], rates[6], time = 0;
        const double still[6] = {0, 0, 0, 0, 0, 0};
        OK(mozzi_model_with_state(model, "home", theta, still, 0.5, &edited));
        OK(mozzi_model_with_start(edited, "home", &further));
        CHECK(mozzi_model_state_count(further) == 1 && strcmp(mozzi_model_state_name(further, 0), "home") == 0);
        OK(mozzi_model_state(further, "home", found, NULL, NULL));
        CHECK(difference(found, theta, 6) == 0);
        OK(mozzi_model_start(further, found, rates, &time));
        CHECK(difference(found, theta, 6) == 0 && difference(rates, still, 6) == 0 && time == 0.5);
        OK(mozzi_model_free(further));
        OK(mozzi_model_free(edited));
    }
    {
        mozzi_frame from, to;
        OK(mozzi_model_with_base(model, 1, &edited));
        CHECK(mozzi_model_n(edited) == 12 && mozzi_model_nq(edited) == 13);
        OK(mozzi_model_free(edited));
        OK(mozzi_model_frame(model, "upper_arm_link", &from));
        OK(mozzi_model_frame(model, "wrist_2_link", &to));
        OK(mozzi_model_sub_chain(model, from, to, &edited));
        CHECK(mozzi_model_n(edited) == 3);
        OK(mozzi_model_free(edited));
    }
    OK(mozzi_model_free(model));
}

static void constraints(void) {
    static const char rail[] = "{\"constraints\": [{\"name\": \"rod\", \"kind\": \"distance\", \"length\": 0.8, \"a\": "
                               "{\"frame\": null}, \"b\": {\"frame\": \"%s\"}}]}";
    mozzi_model *model = embedded("two_link_planar"), *held = NULL, *tree = NULL;
    mozzi_workspace *workspace = NULL;
    mozzi_frame tip;
    char text[256];
    const double guess[2] = {0.3, 0.5}, pushed[2] = {1.0, -2.0}, tau[2] = {0, 0};
    double theta[2], dtheta[2], phi, rate[2], ddtheta[2], lambda, A[2], bias, T[16];
    const char *first = mozzi_model_joint_name(model, 0);
    OK(mozzi_model_end_effector(model, &tip));
    sprintf(text, rail, mozzi_model_frame_name(model, MOZZI_FRAME_NUMBER(tip)));
    OK(mozzi_model_with_constraints(model, text, &held));
    CHECK(mozzi_model_constraint_rows(held) == 1);
    CHECK(strncmp(mozzi_model_constraint_row_name(held, 0), "rod.", 4) == 0);
    OK(mozzi_assemble(held, guess, &first, 1, theta));
    CHECK(theta[0] == guess[0]);
    OK(mozzi_assemble_velocities(held, theta, pushed, NULL, 0, dtheta));
    OK(mozzi_workspace_new(held, &workspace));
    OK(mozzi_constraint_residual(held, workspace, theta, &phi));
    CHECK(fabs(phi) < 1e-10);
    OK(mozzi_model_end_effector(held, &tip));
    OK(mozzi_forward_kinematics(held, workspace, theta, tip, mozzi_by_rows(T, 4)));
    CHECK(fabs(sqrt(T[3] * T[3] + T[7] * T[7] + T[11] * T[11]) - 0.8) < 1e-9);
    OK(mozzi_constraint_jacobian(held, workspace, theta, mozzi_by_rows(A, 2)));
    CHECK(fabs(A[0] * dtheta[0] + A[1] * dtheta[1]) < 1e-10);
    OK(mozzi_constraint_bias(held, workspace, theta, dtheta, &bias));
    OK(mozzi_constrained_forward_dynamics(held, workspace, theta, dtheta, tau, NULL, ddtheta, &lambda));
    CHECK(fabs(A[0] * ddtheta[0] + A[1] * ddtheta[1] + bias) < 1e-9);
    OK(mozzi_constraint_impulse(held, workspace, theta, pushed, rate, &lambda));
    CHECK(fabs(A[0] * rate[0] + A[1] * rate[1]) < 1e-9);
    OK(mozzi_workspace_free(workspace));
    OK(mozzi_model_without_constraints(held, &tree));
    CHECK(mozzi_model_constraint_rows(tree) == 0);
    {
        mozzi_simulation_options options;
        mozzi_ending ending;
        OK(mozzi_simulation_defaults(0.5, 500, &options));
        OK(mozzi_simulate(held, NULL, &options, theta, dtheta, NULL, NULL, NULL, &ending));
        CHECK(ending.complete == 1 && ending.constraint_residual < 1e-6);
        EXPECT(MOZZI_CONSTRAINT, mozzi_simulate(held, NULL, &options, guess, dtheta, NULL, NULL, NULL, NULL));
    }
    OK(mozzi_model_free(tree));
    OK(mozzi_model_free(held));
    OK(mozzi_model_free(model));
}

/* The positions of a floating base move on their manifold. */
static void positions(void) {
    mozzi_model *model = embedded("anymal"), *floating = NULL;
    double theta[32], start[32], dtheta[32], back[32];
    size_t k, n;
    OK(mozzi_model_with_base(model, 1, &floating));
    n = mozzi_model_n(floating);
    OK(mozzi_model_start(floating, start, NULL, NULL));
    memcpy(theta, start, sizeof theta);
    for (k = 0; k < n; ++k) {
        dtheta[k] = 0.1 * (double)(k + 1) / (double)n;
    }
    OK(mozzi_integrate(floating, theta, dtheta, 0.5));
    OK(mozzi_difference(floating, start, theta, back));
    for (k = 0; k < n; ++k) {
        CHECK(fabs(back[k] - 0.5 * dtheta[k]) < 1e-12);
    }
    OK(mozzi_model_free(floating));
    OK(mozzi_model_free(model));
}

static int32_t brake(void *user, double t, const double *theta, const double *dtheta, double *tau) {
    (void)t, (void)theta;
    tau[0] -= 3 * dtheta[0];
    tau[1] -= 3 * dtheta[1];
    ++*(size_t *)user;
    return 0;
}

static int32_t record(void *user, const mozzi_sample *sample) {
    ++*(size_t *)user;
    CHECK(sample->t >= 0 && isfinite(sample->kinetic_energy) && isfinite(sample->theta[1]));
    return sample->t > 0.8;
}

static void motions(void) {
    mozzi_model *model = embedded("double_pendulum");
    mozzi_batch *batch = NULL;
    mozzi_program *program = NULL;
    mozzi_simulation_options options;
    mozzi_ending ending;
    const int32_t quantity = MOZZI_FORWARD_DYNAMICS;
    const double theta[2] = {0.4, -0.2}, dtheta[2] = {0.1, 0.3}, tau[4] = {0, 0, 0, 0};
    double many_theta[4] = {0.4, -0.2, 0.4, -0.2}, many_dtheta[4] = {0.1, 0.3, 0.1, 0.3};
    size_t calls = 0;
    OK(mozzi_simulation_defaults(1, 100, &options));
    OK(mozzi_simulate(model, NULL, &options, theta, dtheta, brake, NULL, &calls, &ending));
    CHECK(ending.complete == 1 && ending.steps == 100 && calls > 300);
    calls = 0;
    OK(mozzi_simulate(model, NULL, &options, theta, dtheta, NULL, record, &calls, &ending));
    CHECK(ending.complete == 0 && calls == 82);
    OK(mozzi_program_new(model, &quantity, NULL, 1, &program));
    OK(mozzi_simulate(model, program, &options, theta, dtheta, NULL, NULL, NULL, &ending));
    /* two robots by a batch, as one by hand */
    OK(mozzi_batch_with_program(program, 1, &batch));
    OK(mozzi_batch_simulate(batch, 2, many_theta, many_dtheta, tau, NULL, MOZZI_RUNGE_KUTTA_4, 0.5, 50));
    CHECK(many_theta[0] == many_theta[2] && many_theta[1] == many_theta[3] && many_theta[0] != theta[0]);
    {
        const double gravities[6] = {0, 0, 0, 0, 0, -9.81};
        double tau_of_each[4], g[2];
        mozzi_batch_environment around = {NULL, gravities, NULL, NULL, 0};
        const mozzi_table in = {many_theta, 4};
        const mozzi_table_out out = {tau_of_each, 4};
        OK(mozzi_batch_compute(batch, MOZZI_GRAVITY_FORCES, NULL, 2, &in, 1, &around, &out, 1));
        gravity_forces(model, many_theta, g);
        CHECK(tau_of_each[0] == 0 && tau_of_each[1] == 0);
        CHECK(difference(tau_of_each + 2, g, 2) < 1e-12);
        OK(mozzi_batch_free(batch));
        OK(mozzi_batch_kernels_only(model, 2, &batch));
        OK(mozzi_batch_compute(batch, MOZZI_GRAVITY_FORCES, NULL, 2, &in, 1, &around, &out, 1));
        CHECK(tau_of_each[2] == g[0] && tau_of_each[3] == g[1]);
    }
    OK(mozzi_batch_free(batch));
    OK(mozzi_program_free(program));
    OK(mozzi_model_free(model));
}

static void inverse_kinematics(void) {
    mozzi_model *model = embedded("panda");
    mozzi_inverse_kinematics *solver = NULL;
    mozzi_frame hand;
    mozzi_solution solution;
    const size_t n = mozzi_model_n(model);
    double theta[16] = {0.3, -0.5, 0.2, -1.8, 0.1, 1.5, 0.4}, guess[16] = {0, 0, 0, -1.5, 0, 1.5, 0}, T[16], found[16],
           reached[16];
    size_t k;
    CHECK(n <= 16);
    OK(mozzi_model_frame(model, "panda_hand", &hand));
    pose_of(model, theta, hand, T);
    OK(mozzi_inverse_kinematics_new(model, hand, NULL, &solver));
    OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSE, T, guess, NULL, found, &solution));
    pose_of(model, found, hand, reached);
    CHECK(difference(reached, T, 16) < 1e-7 && solution.angle < 1e-8 && solution.distance < 1e-8);
    CHECK(solution.starts >= 1 && solution.iterations >= 1);
    /* the nearest to theta is theta */
    OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSE, T, guess, theta, found, NULL));
    CHECK(difference(found, theta, 7) < 1e-3);
    {
        const double p[3] = {T[3], T[7], T[11]};
        OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSITION, p, guess, NULL, found, &solution));
        pose_of(model, found, hand, reached);
        CHECK(isnan(solution.angle) && solution.distance < 1e-8);
        for (k = 0; k < 3; ++k) {
            CHECK(fabs(reached[4 * k + 3] - p[k]) < 1e-7);
        }
    }
    {
        double R[9];
        for (k = 0; k < 9; ++k) {
            R[k] = T[4 * (k / 3) + k % 3];
        }
        OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_ORIENTATION, R, guess, NULL, found, &solution));
        pose_of(model, found, hand, reached);
        CHECK(isnan(solution.distance) && solution.angle < 1e-8);
        for (k = 0; k < 9; ++k) {
            CHECK(fabs(reached[4 * (k / 3) + k % 3] - R[k]) < 1e-7);
        }
    }
    OK(mozzi_model_free(model)); /* the solver keeps what it needs */
    OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSE, T, guess, NULL, found, NULL));
    OK(mozzi_inverse_kinematics_free(solver));
}

int main(void) {
    loading();
    properties();
    edits();
    constraints();
    positions();
    motions();
    inverse_kinematics();
    return 0;
}
