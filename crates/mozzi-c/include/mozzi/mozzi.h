/* mozzi: robot dynamics in the notation of Lynch and Park, Modern Robotics. The C interface.
 *
 *   τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇)
 *
 * SI units. Six-vectors are angular first: twists (ω, v), wrenches (m, f). An applied wrench is what the robot applies
 * to its environment. θ has nq entries, θ̇, θ̈ and τ have n. See CONVENTIONS.md.
 *
 * Statuses. A function returns a mozzi_status: 0, or the reason why it failed; mozzi_last_error() has the names and the
 * numbers. Results are written if the status is 0 only, except after MOZZI_SINGULAR, which fills the outputs with NaN,
 * MOZZI_NOT_REACHED, which leaves the nearest positions, and a failed mozzi_batch_simulate, which leaves states that are
 * partly advanced.
 *
 * Memory. mozzi_…_new and the like write a handle that mozzi_…_free frees; a handle keeps what it needs, so that the
 * order of freeing is free. Freeing NULL does nothing. Use of a freed handle is undefined, as in all of C.
 *
 * Real time. A call on a workspace (the quantities, mozzi_compute, mozzi_integrate, mozzi_difference) allocates nothing,
 * takes no lock, makes no system call, and takes a time that does not depend on the numbers: see docs/cpp.md.
 *
 * Threads. A model, a program and a batch may be used by several threads at once. A workspace and a solver of inverse
 * kinematics are for one call at a time; a second one at the same time returns MOZZI_BUSY. After a fork, batches made
 * before it return MOZZI_FORKED; everything else goes on.
 *
 * Written by hand, but for the quantities, which `cargo xtask docs` writes from their list.
 */
#ifndef MOZZI_H
#define MOZZI_H

#include <stddef.h>
#include <stdint.h>

#define MOZZI_VERSION "0.1.0"
/* The number in the soname, libmozzi.so.0. */
#define MOZZI_ABI_VERSION 0

#ifdef __cplusplus
extern "C" {
#endif

/* The library's version and its number of the interface, to be compared with those above. */
const char *mozzi_version(void);
uint32_t mozzi_abi_version(void);

/* ------------------------------------------------------------------------------------------------ statuses */

typedef int32_t mozzi_status;
enum {
    MOZZI_OK = 0,
    MOZZI_NULL = 1,             /* a pointer is null, or not aligned */
    MOZZI_INVALID_HANDLE = 2,   /* not a handle of this kind and this library, or freed */
    MOZZI_FOREIGN = 3,          /* a workspace, frame or program of another model */
    MOZZI_BUSY = 4,             /* another thread is using this workspace or solver */
    MOZZI_WRONG_LENGTH = 5,     /* an array of a wrong length */
    MOZZI_NOT_FINITE = 6,       /* an argument is NaN or infinite */
    MOZZI_INVALID_ARGUMENT = 7, /* an argument is outside its domain, such as a quaternion that is not of length 1 */
    MOZZI_NOT_FOUND = 8,        /* there is no frame, joint, state, quantity or robot of this name or number */
    MOZZI_NO_FILE = 9,          /* the file cannot be read */
    MOZZI_REFUSED = 10,         /* the robot has errors: see the diagnostics */
    MOZZI_SINGULAR = 11,        /* the mass matrix or the task is singular */
    MOZZI_CONSTRAINT = 12,      /* the constraints cannot be satisfied */
    MOZZI_DIVERGED = 13,        /* a simulated state became infinite or NaN, or the simulation does not advance */
    MOZZI_NOT_REACHED = 14,     /* inverse kinematics found no positions */
    MOZZI_CALLBACK = 15,        /* a callback reported a failure */
    MOZZI_FORKED = 16,          /* the batch was made before the process forked */
    MOZZI_INTERNAL = 17         /* a bug of mozzi: please report it */
};

/* A few words about a status. */
const char *mozzi_status_text(mozzi_status status);
/* The text of the last failure in this thread, with names and numbers; empty before the first. It is valid until the
 * thread's next failure. The first call in a thread may allocate its memory: in a real-time thread, call this function
 * once before the loop. */
const char *mozzi_last_error(void);
/* Stores the text "NAME has FOUND entries, expected EXPECTED" and returns MOZZI_WRONG_LENGTH: for wrappers in other
 * languages that know lengths. */
mozzi_status mozzi_report_length(const char *name, size_t found, size_t expected);
/* Likewise for a vector whose numbers do not lie next to each other. */
mozzi_status mozzi_report_gaps(const char *name);

/* ------------------------------------------------------------------------------------------------- handles */

/* A robot: constants alone, shared by all threads. */
typedef struct mozzi_model mozzi_model;
/* Memory for calls at one state, of one thread at a time. */
typedef struct mozzi_workspace mozzi_workspace;
/* Quantities of a robot as machine code. */
typedef struct mozzi_program mozzi_program;
/* A robot prepared for many states. */
typedef struct mozzi_batch mozzi_batch;
/* A solver of inverse kinematics. */
typedef struct mozzi_inverse_kinematics mozzi_inverse_kinematics;
/* Errors and warnings of a robot's file. */
typedef struct mozzi_diagnostics mozzi_diagnostics;

/* A named frame of one model: a link of its file, or a frame that was added. An edited model has its own frames. */
typedef uint64_t mozzi_frame;
/* Its number, from 0: the row of mozzi_frame_poses. */
#define MOZZI_FRAME_NUMBER(frame) ((size_t)((frame) & 0xffffffffu))

/* ------------------------------------------------------------------------------------------------- loading */

/* How strictly a file is read. */
enum {
    MOZZI_POLICY_DEFAULT = 0, /* errors refuse the file; warnings are reported */
    MOZZI_POLICY_STRICT = 1,  /* warnings are errors */
    MOZZI_POLICY_LENIENT = 2  /* unphysical inertias are repaired, with a warning */
};

typedef struct mozzi_pair {
    const char *name;
    const char *value;
} mozzi_pair;

/* How to read a robot; {0} is the default. */
typedef struct mozzi_load_options {
    int32_t policy;                    /* MOZZI_POLICY_… */
    int32_t floating;                  /* 1: a floating base, whatever the file says */
    const mozzi_pair *xacro_arguments; /* values of $(arg name) */
    size_t xacro_argument_count;
    const mozzi_pair *packages; /* names and folders, for $(find name) */
    size_t package_count;
} mozzi_load_options;

/* Each writes a model, and, unless `diagnostics` is NULL, what is wrong or odd about the file, of a refused one, too.
 * `options` may be NULL. URDF, xacro, MJCF and SDFormat are told apart by their content. */

/* A file, or else the embedded robot of this name. */
mozzi_status mozzi_model_open(const char *name_or_path, const mozzi_load_options *options, mozzi_model **model,
                              mozzi_diagnostics **diagnostics);
/* A file. */
mozzi_status mozzi_model_load(const char *path, const mozzi_load_options *options, mozzi_model **model,
                              mozzi_diagnostics **diagnostics);
/* A text of this many bytes; diagnostics call it by this name. */
mozzi_status mozzi_model_parse(const char *name, const char *text, size_t length, const mozzi_load_options *options,
                               mozzi_model **model, mozzi_diagnostics **diagnostics);
/* An embedded robot: anymal, panda, ur5, … */
mozzi_status mozzi_model_embedded(const char *name, mozzi_model **model);
size_t mozzi_embedded_count(void);
const char *mozzi_embedded_name(size_t k);
/* Another handle of the same model, to be freed as well; frames and workspaces of one are those of the other. */
mozzi_status mozzi_model_copy(const mozzi_model *model, mozzi_model **copy);
mozzi_status mozzi_model_free(mozzi_model *model);

/* What a finding means for results: the order of warnings. */
enum {
    MOZZI_CONSEQUENCE_MOTION = 0,  /* something is not computed, or replaced: the robot may move differently */
    MOZZI_CONSEQUENCE_NUMBERS = 1, /* the file's numbers are used, but are suspicious */
    MOZZI_CONSEQUENCE_REMARK = 2,  /* the dynamics are those of the file */
    MOZZI_CONSEQUENCE_UNUSED = 3   /* appearance and contact */
};

/* A finding; its texts live as long as the diagnostics. */
typedef struct mozzi_diagnostic {
    int32_t is_error;    /* 1 for an error, 0 for a warning */
    int32_t consequence; /* MOZZI_CONSEQUENCE_… */
    const char *code;    /* such as mozzi::urdf::zero_axis */
    const char *message;
    const char *file;
    size_t line;   /* from 1 */
    size_t column; /* from 1, in characters */
    const char *calls; /* the calls of xacro macros that lead there, or "" */
    const char *help;  /* the remedy, or NULL */
    const char *text;  /* all of it in a line: file:line:column: error: message */
} mozzi_diagnostic;

size_t mozzi_diagnostics_count(const mozzi_diagnostics *diagnostics);
mozzi_status mozzi_diagnostics_get(const mozzi_diagnostics *diagnostics, size_t k, mozzi_diagnostic *diagnostic);
/* One finding per line, those without consequence left out. */
const char *mozzi_diagnostics_text(const mozzi_diagnostics *diagnostics);
mozzi_status mozzi_diagnostics_free(mozzi_diagnostics *diagnostics);

/* --------------------------------------------------------------------------------------------------- model */

/* Sizes; 0 for an invalid handle. */
size_t mozzi_model_n(const mozzi_model *model);               /* velocities: θ̇, θ̈, τ */
size_t mozzi_model_nq(const mozzi_model *model);              /* positions: θ */
size_t mozzi_model_joint_count(const mozzi_model *model);     /* independent joints */
size_t mozzi_model_frame_count(const mozzi_model *model);     /* frames */
size_t mozzi_model_body_count(const mozzi_model *model);      /* b: a floating base, and the moving links */
size_t mozzi_model_parameter_count(const mozzi_model *model); /* p: inertial parameters */
size_t mozzi_model_constraint_rows(const mozzi_model *model); /* m: rows of the constraints */
size_t mozzi_model_state_count(const mozzi_model *model);     /* named states */
size_t mozzi_model_is_floating(const mozzi_model *model);     /* 1 for a floating base */
double mozzi_model_mass(const mozzi_model *model);            /* kg; NaN for an invalid handle */

/* The k-th name, NULL if there is none; it lives as long as the model. */
const char *mozzi_model_name(const mozzi_model *model);
const char *mozzi_model_joint_name(const mozzi_model *model, size_t k);
const char *mozzi_model_position_name(const mozzi_model *model, size_t k);
const char *mozzi_model_velocity_name(const mozzi_model *model, size_t k);
const char *mozzi_model_frame_name(const mozzi_model *model, size_t k);
const char *mozzi_model_parameter_name(const mozzi_model *model, size_t k);
const char *mozzi_model_constraint_row_name(const mozzi_model *model, size_t k);
const char *mozzi_model_state_name(const mozzi_model *model, size_t k);

/* Frames: by name, by number, the end effector. */
mozzi_status mozzi_model_frame(const mozzi_model *model, const char *name, mozzi_frame *frame);
mozzi_status mozzi_model_frame_at(const mozzi_model *model, size_t k, mozzi_frame *frame);
mozzi_status mozzi_model_end_effector(const mozzi_model *model, mozzi_frame *frame);

mozzi_status mozzi_model_gravity(const mozzi_model *model, double gravity[3]);       /* in {s}, m/s² */
mozzi_status mozzi_model_parameters(const mozzi_model *model, double *parameters);   /* π, p numbers */
/* Joint k's first index and number of entries in θ (q, positions) and in θ̇ (j, velocities); each may be NULL. */
mozzi_status mozzi_model_joint_place(const mozzi_model *model, size_t k, size_t *q, size_t *positions, size_t *j,
                                     size_t *velocities);
/* Limits of each independent joint, ±INFINITY where there is none; each array may be NULL. Those of position include
 * the limits of mimic joints; that of a ball is an angle. rad or m; rad/s or m/s; N m or N. */
mozzi_status mozzi_model_limits(const mozzi_model *model, double *lower, double *upper, double *velocity,
                                double *effort);
/* For each velocity 1 if it has a motor, else 0. */
mozzi_status mozzi_model_motors(const mozzi_model *model, uint8_t *is_driven);

/* The named states of the file, and the state in which the robot starts; each array may be NULL. */
mozzi_status mozzi_model_state(const mozzi_model *model, const char *name, double *theta, double *dtheta,
                               double *time);
mozzi_status mozzi_model_start(const mozzi_model *model, double *theta, double *dtheta, double *time);

/* θ ← θ ⊕ θ̇h, and δ = θ₁ ⊖ θ₀, n numbers: sums and differences for joints of one axis, exponentials and logarithms for
 * a floating base, balls and free joints. Real time. No array may overlap another. */
mozzi_status mozzi_integrate(const mozzi_model *model, double *theta, const double *dtheta, double h);
mozzi_status mozzi_difference(const mozzi_model *model, const double *theta0, const double *theta1,
                              double *difference);

/* ------------------------------------------------------------------------------- edits: each gives a new model */

/* A payload on a frame: (m, m c_x, m c_y, m c_z, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz) in its coordinates, I about its
 * origin: kg, kg m, kg m². */
mozzi_status mozzi_model_with_payload(const mozzi_model *model, mozzi_frame frame, const double parameters[10],
                                      mozzi_model **edited);
/* Joints locked at these positions, and their mimic joints with them. */
mozzi_status mozzi_model_with_locked_joints(const mozzi_model *model, const char *const *joints,
                                            const double *positions, size_t count, mozzi_model **edited);
/* A further frame at T relative to another, 4 × 4 by rows. */
mozzi_status mozzi_model_with_frame(const mozzi_model *model, const char *name, mozzi_frame on, const double T[16],
                                    mozzi_model **edited);
mozzi_status mozzi_model_with_end_effector(const mozzi_model *model, mozzi_frame frame, mozzi_model **edited);
mozzi_status mozzi_model_with_gravity(const mozzi_model *model, const double gravity[3], mozzi_model **edited);
/* A floating base (1) or a fixed one (0). */
mozzi_status mozzi_model_with_base(const mozzi_model *model, int32_t floating, mozzi_model **edited);
/* The chain between two links, the first as its base. */
mozzi_status mozzi_model_sub_chain(const mozzi_model *model, mozzi_frame from, mozzi_frame to, mozzi_model **edited);
/* Other inertial parameters π, p numbers. Edits of the edited model keep them. */
mozzi_status mozzi_model_with_parameters(const mozzi_model *model, const double *parameters, mozzi_model **edited);
/* The constraints and motors of a text in JSON or YAML, such as
 * {"constraints": [{"name": "foot", "kind": "point", "a": {"frame": null}, "b": {"frame": "foot"}}]}. */
mozzi_status mozzi_model_with_constraints(const mozzi_model *model, const char *constraints, mozzi_model **edited);
mozzi_status mozzi_model_without_constraints(const mozzi_model *model, mozzi_model **edited);
mozzi_status mozzi_model_with_state(const mozzi_model *model, const char *name, const double *theta,
                                    const double *dtheta, double time, mozzi_model **edited);
mozzi_status mozzi_model_with_start(const mozzi_model *model, const char *name, mozzi_model **edited);

/* Positions, and velocities, near a guess that satisfy the constraints; the joints of `hold` keep theirs. */
mozzi_status mozzi_assemble(const mozzi_model *model, const double *guess, const char *const *hold, size_t hold_count,
                            double *theta);
mozzi_status mozzi_assemble_velocities(const mozzi_model *model, const double *theta, const double *guess,
                                       const char *const *hold, size_t hold_count, double *dtheta);

/* ---------------------------------------------------------------------------------- workspaces and programs */

mozzi_status mozzi_workspace_new(const mozzi_model *model, mozzi_workspace **workspace);
mozzi_status mozzi_workspace_free(mozzi_workspace *workspace);

/* Compiles these quantities, MOZZI_INVERSE_DYNAMICS and so on, to machine code for the robot in its own environment;
 * `subjects` has one for each, or is NULL. An arm's inverse dynamics takes a quarter of a millisecond. Without code for
 * this processor, or if it would be too long, the kernels compute the quantity. */
typedef struct mozzi_subject mozzi_subject;
mozzi_status mozzi_program_new(const mozzi_model *model, const int32_t *quantities, const mozzi_subject *subjects,
                               size_t count, mozzi_program **program);
mozzi_status mozzi_program_free(mozzi_program *program);
/* 1 if there is machine code for this quantity, else 0. */
int32_t mozzi_program_has_code(const mozzi_program *program, int32_t quantity, const mozzi_subject *subject);
/* A workspace whose calls with the environment NULL use the machine code, for the program's model. */
mozzi_status mozzi_workspace_with_program(const mozzi_program *program, mozzi_workspace **workspace);

/* ------------------------------------------------------------------------------------- arguments of quantities */

/* A wrench (m, f) that a frame applies to the environment, in the frame's own coordinates: N m, N. */
typedef struct mozzi_wrench {
    mozzi_frame frame;
    double F[6];
} mozzi_wrench;

/* What surrounds the robot; NULL in its place is the model's own: its gravity, {s} at rest, no wrenches. Begin with
 * mozzi_model_environment: {0} has no gravity. */
typedef struct mozzi_environment {
    double gravity[3];           /* in the axes of {s}, m/s² */
    double base_twist[6];        /* (ω, v) of {s} */
    double base_acceleration[6]; /* (ω̇, v̇) of {s}, without gravity */
    const mozzi_wrench *wrenches; /* at most one for each frame */
    size_t wrench_count;
} mozzi_environment;
/* The model's own. */
mozzi_status mozzi_model_environment(const mozzi_model *model, mozzi_environment *environment);

enum {
    MOZZI_BODY = 0, /* coordinates of the frame */
    MOZZI_SPACE = 1 /* coordinates of {s} */
};

/* Rows of a frame's twist (ω_x, ω_y, ω_z, v_x, v_y, v_z): the numbers 0 to 5, each at most once; none for all six. */
typedef struct mozzi_task {
    mozzi_frame frame;
    int32_t coordinates; /* MOZZI_BODY or MOZZI_SPACE */
    const size_t *rows;
    size_t row_count;
} mozzi_task;

/* The frame, task or point of a quantity that is called by its number. */
struct mozzi_subject {
    mozzi_task task;
    double about[3];
};

/* Where a matrix goes: entry (i, j) at data[i * row_stride + j * column_stride]. Results may overlap arguments. */
typedef struct mozzi_matrix {
    double *data;
    ptrdiff_t row_stride;
    ptrdiff_t column_stride;
} mozzi_matrix;

/* Where a list of matrices goes: entry (k, i, j) at data[k * block_stride + i * row_stride + j * column_stride]. */
typedef struct mozzi_tensor {
    double *data;
    ptrdiff_t block_stride;
    ptrdiff_t row_stride;
    ptrdiff_t column_stride;
} mozzi_tensor;

/* A matrix by rows, with this many columns; by columns, with this many rows; a list of matrices by rows. */
static inline mozzi_matrix mozzi_by_rows(double *data, size_t columns) {
    mozzi_matrix matrix;
    matrix.data = data;
    matrix.row_stride = (ptrdiff_t)columns;
    matrix.column_stride = 1;
    return matrix;
}
static inline mozzi_matrix mozzi_by_columns(double *data, size_t rows) {
    mozzi_matrix matrix;
    matrix.data = data;
    matrix.row_stride = 1;
    matrix.column_stride = (ptrdiff_t)rows;
    return matrix;
}
static inline mozzi_tensor mozzi_list_by_rows(double *data, size_t rows, size_t columns) {
    mozzi_tensor tensor;
    tensor.data = data;
    tensor.block_stride = (ptrdiff_t)(rows * columns);
    tensor.row_stride = (ptrdiff_t)columns;
    tensor.column_stride = 1;
    return tensor;
}

/* -------------------------------------------------------------------------------------------- the quantities */

/* Each at one state, in real time. Shapes are in parentheses: n velocities, nq positions, p parameters, b bodies, k
 * rows of a task, m rows of the constraints; units for revolute joints, then for prismatic ones. */

/* The quantities: from here on written by `cargo xtask docs`. */

/* Their numbers. */
enum {
    MOZZI_INVERSE_DYNAMICS = 0,
    MOZZI_FORWARD_DYNAMICS = 1,
    MOZZI_FORWARD_DYNAMICS_BY_MASS_MATRIX = 2,
    MOZZI_FORWARD_DYNAMICS_BY_INVERSE_DYNAMICS = 3,
    MOZZI_MASS_MATRIX = 4,
    MOZZI_MASS_MATRIX_INVERSE = 5,
    MOZZI_MASS_MATRIX_RATE = 6,
    MOZZI_CORIOLIS_MATRIX = 7,
    MOZZI_VELOCITY_PRODUCT = 8,
    MOZZI_GRAVITY_FORCES = 9,
    MOZZI_BIAS_FORCES = 10,
    MOZZI_TIP_FORCES = 11,
    MOZZI_JOINT_FRICTION = 12,
    MOZZI_SPRING_FORCES = 13,
    MOZZI_KINETIC_ENERGY = 14,
    MOZZI_POTENTIAL_ENERGY = 15,
    MOZZI_FORWARD_KINEMATICS = 16,
    MOZZI_FRAME_POSES = 17,
    MOZZI_SPACE_JACOBIAN = 18,
    MOZZI_BODY_JACOBIAN = 19,
    MOZZI_SPACE_JACOBIAN_RATE = 20,
    MOZZI_BODY_JACOBIAN_RATE = 21,
    MOZZI_SPACE_JACOBIAN_DERIVATIVE = 22,
    MOZZI_BODY_JACOBIAN_DERIVATIVE = 23,
    MOZZI_FRAME_ACCELERATION = 24,
    MOZZI_TASK_SPACE_DYNAMICS = 25,
    MOZZI_CONSTRAINED_FORWARD_DYNAMICS = 26,
    MOZZI_CONSTRAINT_JACOBIAN = 27,
    MOZZI_CONSTRAINT_BIAS = 28,
    MOZZI_CONSTRAINT_RESIDUAL = 29,
    MOZZI_CONSTRAINT_PROJECTION = 30,
    MOZZI_CONSTRAINT_IMPULSE = 31,
    MOZZI_INVERSE_DYNAMICS_DERIVATIVES = 32,
    MOZZI_FORWARD_DYNAMICS_DERIVATIVES = 33,
    MOZZI_INVERSE_DYNAMICS_VJP = 34,
    MOZZI_FORWARD_DYNAMICS_VJP = 35,
    MOZZI_INVERSE_DYNAMICS_PARAMETER_VJP = 36,
    MOZZI_FORWARD_DYNAMICS_PARAMETER_VJP = 37,
    MOZZI_MASS_MATRIX_PRODUCT_VJP = 38,
    MOZZI_ENERGY_GRADIENTS = 39,
    MOZZI_FRAME_TWIST_VJP = 40,
    MOZZI_FRAME_ACCELERATION_VJP = 41,
    MOZZI_MOMENTUM_VJP = 42,
    MOZZI_MOMENTUM_RATE_VJP = 43,
    MOZZI_GRAVITY_FORCES_DERIVATIVE = 44,
    MOZZI_TIP_FORCES_DERIVATIVE = 45,
    MOZZI_MASS_MATRIX_PRODUCT_DERIVATIVE = 46,
    MOZZI_CENTER_OF_MASS = 47,
    MOZZI_CENTER_OF_MASS_VELOCITY = 48,
    MOZZI_CENTER_OF_MASS_ACCELERATION = 49,
    MOZZI_CENTER_OF_MASS_JACOBIAN = 50,
    MOZZI_MOMENTUM = 51,
    MOZZI_MOMENTUM_RATE = 52,
    MOZZI_CENTROIDAL_MOMENTUM_MATRIX = 53,
    MOZZI_CENTROIDAL_MOMENTUM_BIAS = 54,
    MOZZI_REGRESSOR = 55,
    MOZZI_ENERGY_REGRESSORS = 56
};

/* τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇), the joint forces of a motion.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². environment: or NULL for the model's
 * own.
 * Gives tau (n), N m or N. */
mozzi_status mozzi_inverse_dynamics(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const double *dtheta, const double *ddtheta, const mozzi_environment *environment,
                                    double *tau);

/* θ̈ = M⁻¹(τ − c − g − JᵀF − f), the accelerations that joint forces produce.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. environment: or NULL for the model's own.
 * Gives ddtheta (n), rad/s² or m/s². */
mozzi_status mozzi_forward_dynamics(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const double *dtheta, const double *tau, const mozzi_environment *environment,
                                    double *ddtheta);

/* θ̈ = M⁻¹(τ − c − g − JᵀF − f), by composite bodies and the factors of M along the tree.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. environment: or NULL for the model's own.
 * Gives ddtheta (n), rad/s² or m/s². */
mozzi_status mozzi_forward_dynamics_by_mass_matrix(const mozzi_model *model, mozzi_workspace *workspace,
                                                   const double *theta, const double *dtheta, const double *tau,
                                                   const mozzi_environment *environment, double *ddtheta);

/* θ̈ = M⁻¹(τ − c − g − JᵀF − f), M and h by calls of inverse dynamics.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. environment: or NULL for the model's own.
 * Gives ddtheta (n), rad/s² or m/s². */
mozzi_status mozzi_forward_dynamics_by_inverse_dynamics(const mozzi_model *model, mozzi_workspace *workspace,
                                                        const double *theta, const double *dtheta, const double *tau,
                                                        const mozzi_environment *environment, double *ddtheta);

/* M(θ), symmetric, with the rotors' inertia on its diagonal.
 * theta (nq), rad or m.
 * Gives M (n × n), kg m², kg m or kg. */
mozzi_status mozzi_mass_matrix(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                               mozzi_matrix M);

/* M(θ)⁻¹, the accelerations that a unit of each joint force produces.
 * theta (nq), rad or m.
 * Gives inverse (n × n), 1/(kg m²), 1/(kg m) or 1/kg. */
mozzi_status mozzi_mass_matrix_inverse(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                       mozzi_matrix inverse);

/* Ṁ(θ, θ̇) = C + Cᵀ.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives dM (n × n), kg m²/s, kg m/s or kg/s. */
mozzi_status mozzi_mass_matrix_rate(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const double *dtheta, mozzi_matrix dM);

/* C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew-symmetric.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives C (n × n), N m s, N s or N s/m. */
mozzi_status mozzi_coriolis_matrix(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                   const double *dtheta, mozzi_matrix C);

/* c(θ, θ̇) = Cθ̇, the Coriolis and centripetal forces.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives c (n), N m or N. */
mozzi_status mozzi_velocity_product(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const double *dtheta, double *c);

/* g(θ), the joint forces that hold the robot against gravity.
 * theta (nq), rad or m. environment: or NULL for the model's own.
 * Gives g (n), N m or N. */
mozzi_status mozzi_gravity_forces(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                  const mozzi_environment *environment, double *g);

/* h(θ, θ̇) = c + g, with JᵀF and the base's terms where they are given; without friction and springs.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. environment: or NULL for the model's own.
 * Gives h (n), N m or N. */
mozzi_status mozzi_bias_forces(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                               const double *dtheta, const mozzi_environment *environment, double *h);

/* JᵀF of the wrenches that frames apply to the environment.
 * theta (nq), rad or m. environment: or NULL for the model's own.
 * Gives tau (n), N m or N. */
mozzi_status mozzi_tip_forces(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                              const mozzi_environment *environment, double *tau);

/* f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
 * dtheta (n), rad/s or m/s.
 * Gives f (n), N m or N. */
mozzi_status mozzi_joint_friction(const mozzi_model *model, mozzi_workspace *workspace, const double *dtheta,
                                  double *f);

/* f_s(θ) = k(θ − θ₀) of each joint, θ not wrapped; kφ of a ball, φ its rotation vector.
 * theta (nq), rad or m.
 * Gives f (n), N m or N. */
mozzi_status mozzi_spring_forces(const mozzi_model *model, mozzi_workspace *workspace, const double *theta, double *f);

/* ½θ̇ᵀMθ̇, of all that moves.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. environment: or NULL for the model's own.
 * Gives energy, J. */
mozzi_status mozzi_kinetic_energy(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                  const double *dtheta, const mozzi_environment *environment, double *energy);

/* −Σ m gᵀp + Σ ½k(θ − θ₀)², p seen from the origin of {s}.
 * theta (nq), rad or m. environment: or NULL for the model's own.
 * Gives energy, J. */
mozzi_status mozzi_potential_energy(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const mozzi_environment *environment, double *energy);

/* T_sb(θ), the configuration of a frame {b} seen from {s}.
 * theta (nq), rad or m. frame: of this model.
 * Gives T (4 × 4), m. */
mozzi_status mozzi_forward_kinematics(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                      mozzi_frame frame, mozzi_matrix T);

/* T_sb(θ) of all frames, in the order of the model's list.
 * theta (nq), rad or m.
 * Gives T (frames × 4 × 4), m. */
mozzi_status mozzi_frame_poses(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                               mozzi_tensor T);

/* J_s(θ) of a frame: its twist in {s} is J_sθ̇, (ω, v).
 * theta (nq), rad or m. frame: of this model.
 * Gives J (6 × n), 1 or m. */
mozzi_status mozzi_space_jacobian(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                  mozzi_frame frame, mozzi_matrix J);

/* J_b(θ) of a frame: its twist in its own coordinates is J_bθ̇, (ω, v).
 * theta (nq), rad or m. frame: of this model.
 * Gives J (6 × n), 1 or m. */
mozzi_status mozzi_body_jacobian(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                 mozzi_frame frame, mozzi_matrix J);

/* dJ_s/dt of a frame.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. frame: of this model.
 * Gives dJ (6 × n), 1/s or m/s. */
mozzi_status mozzi_space_jacobian_rate(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                       const double *dtheta, mozzi_frame frame, mozzi_matrix dJ);

/* dJ_b/dt of a frame.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. frame: of this model.
 * Gives dJ (6 × n), 1/s or m/s. */
mozzi_status mozzi_body_jacobian_rate(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                      const double *dtheta, mozzi_frame frame, mozzi_matrix dJ);

/* ∂J_s/∂θ_j of a frame for each velocity j.
 * theta (nq), rad or m. frame: of this model.
 * Gives H (n × 6 × n), 1 or m, each per unit of θ_j. */
mozzi_status mozzi_space_jacobian_derivative(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                             mozzi_frame frame, mozzi_tensor H);

/* ∂J_b/∂θ_j of a frame for each velocity j.
 * theta (nq), rad or m. frame: of this model.
 * Gives H (n × 6 × n), 1 or m, each per unit of θ_j. */
mozzi_status mozzi_body_jacobian_derivative(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                            mozzi_frame frame, mozzi_tensor H);

/* the classical acceleration of a frame, angular and of its origin, in its own coordinates.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². frame: of this model.
 * Gives a (6), rad/s², m/s². */
mozzi_status mozzi_frame_acceleration(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                      const double *dtheta, const double *ddtheta, mozzi_frame frame, double *a);

/* Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as the rows of a frame's twist show them.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. task: a frame, coordinates and rows. environment: or NULL for the
 * model's own.
 * Gives Lambda (k × k), kg m², kg m, kg; eta (k), N m, N. */
mozzi_status mozzi_task_space_dynamics(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                       const double *dtheta, const mozzi_task *task,
                                       const mozzi_environment *environment, mozzi_matrix Lambda, double *eta);

/* θ̈ and λ of τ = Mθ̈ + c + g + JᵀF + f + Aᵀλ with Aθ̈ + Ȧθ̇ = 0.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. environment: or NULL for the model's own.
 * Gives ddtheta (n), rad/s² or m/s²; multipliers (m), N m or N. */
mozzi_status mozzi_constrained_forward_dynamics(const mozzi_model *model, mozzi_workspace *workspace,
                                                const double *theta, const double *dtheta, const double *tau,
                                                const mozzi_environment *environment, double *ddtheta,
                                                double *multipliers);

/* A(θ) of the constraints A(θ)θ̇ = 0.
 * theta (nq), rad or m.
 * Gives A (m × n), 1 or m. */
mozzi_status mozzi_constraint_jacobian(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                       mozzi_matrix A);

/* Ȧ(θ, θ̇)θ̇ of the constraints: Aθ̈ + Ȧθ̇ = 0.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives dA_dtheta (m), rad/s² or m/s². */
mozzi_status mozzi_constraint_bias(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                   const double *dtheta, double *dA_dtheta);

/* φ(θ), by how much the positions violate the constraints.
 * theta (nq), rad or m.
 * Gives phi (m), rad or m. */
mozzi_status mozzi_constraint_residual(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                       double *phi);

/* P(θ) = 1 − Aᵀ(A M⁻¹Aᵀ)⁻¹A M⁻¹: Pτ = P(Mθ̈ + h).
 * theta (nq), rad or m.
 * Gives P (n × n), 1, m or 1/m. */
mozzi_status mozzi_constraint_projection(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                         mozzi_matrix P);

/* θ̇⁺ and Λ of M(θ̇⁺ − θ̇) = −AᵀΛ with Aθ̇⁺ = 0: the velocities after the constraints have begun to act.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives dtheta_after (n), rad/s or m/s; impulse (m), N m s or N s. */
mozzi_status mozzi_constraint_impulse(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                      const double *dtheta, double *dtheta_after, double *impulse);

/* ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². environment: or NULL for the model's
 * own.
 * Gives d_theta (n × n), N m or N, each per unit of its column; d_dtheta (n × n), N m or N, each per unit of its
 * column; d_ddtheta (n × n), N m or N, each per unit of its column. */
mozzi_status mozzi_inverse_dynamics_derivatives(const mozzi_model *model, mozzi_workspace *workspace,
                                                const double *theta, const double *dtheta, const double *ddtheta,
                                                const mozzi_environment *environment, mozzi_matrix d_theta,
                                                mozzi_matrix d_dtheta, mozzi_matrix d_ddtheta);

/* θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, row i of θ̈_i; by θ along the velocities.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. environment: or NULL for the model's own.
 * Gives ddtheta (n), rad/s² or m/s²; d_theta (n × n), rad/s² or m/s², each per unit of its column; d_dtheta (n × n),
 * rad/s² or m/s², each per unit of its column; d_tau (n × n), rad/s² or m/s², each per unit of its column. */
mozzi_status mozzi_forward_dynamics_derivatives(const mozzi_model *model, mozzi_workspace *workspace,
                                                const double *theta, const double *dtheta, const double *tau,
                                                const mozzi_environment *environment, double *ddtheta,
                                                mozzi_matrix d_theta, mozzi_matrix d_dtheta, mozzi_matrix d_tau);

/* xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; x (n), any. environment: or NULL for
 * the model's own.
 * Gives d_theta (n), any; d_dtheta (n), any; d_ddtheta (n), any. */
mozzi_status mozzi_inverse_dynamics_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                        const double *dtheta, const double *ddtheta, const double *x,
                                        const mozzi_environment *environment, double *d_theta, double *d_dtheta,
                                        double *d_ddtheta);

/* xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x, the gradient of xᵀθ̈; by θ along the velocities.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N; x (n), any. environment: or NULL for the model's
 * own.
 * Gives d_theta (n), any; d_dtheta (n), any; d_tau (n), any. */
mozzi_status mozzi_forward_dynamics_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                        const double *dtheta, const double *tau, const double *x,
                                        const mozzi_environment *environment, double *d_theta, double *d_dtheta,
                                        double *d_tau);

/* xᵀ∂τ/∂π = xᵀY, and xᵀ∂τ by the joints' placements and axes and by gravity: the gradient of xᵀτ by the robot.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; x (n), any. environment: or NULL for
 * the model's own.
 * Gives d_parameters (p), any; d_placements (b × 6), any; d_axes (b × 6), any; d_gravity (3), any. */
mozzi_status mozzi_inverse_dynamics_parameter_vjp(const mozzi_model *model, mozzi_workspace *workspace,
                                                  const double *theta, const double *dtheta, const double *ddtheta,
                                                  const double *x, const mozzi_environment *environment,
                                                  double *d_parameters, mozzi_matrix d_placements, mozzi_matrix d_axes,
                                                  double *d_gravity);

/* xᵀ∂θ̈/∂π, and xᵀ∂θ̈ by the joints' placements and axes and by gravity: the gradient of xᵀθ̈ by the robot.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N; x (n), any. environment: or NULL for the model's
 * own.
 * Gives d_parameters (p), any; d_placements (b × 6), any; d_axes (b × 6), any; d_gravity (3), any. */
mozzi_status mozzi_forward_dynamics_parameter_vjp(const mozzi_model *model, mozzi_workspace *workspace,
                                                  const double *theta, const double *dtheta, const double *tau,
                                                  const double *x, const mozzi_environment *environment,
                                                  double *d_parameters, mozzi_matrix d_placements, mozzi_matrix d_axes,
                                                  double *d_gravity);

/* xᵀ∂(M(θ)θ̈)/∂θ along the velocities, and Mx: the gradient of xᵀMθ̈.
 * theta (nq), rad or m; ddtheta (n), rad/s² or m/s²; x (n), any.
 * Gives d_theta (n), any; d_ddtheta (n), any. */
mozzi_status mozzi_mass_matrix_product_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                           const double *ddtheta, const double *x, double *d_theta, double *d_ddtheta);

/* ∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ of the kinetic and potential energy; by θ along the velocities.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. environment: or NULL for the model's own.
 * Gives kinetic_d_theta (n), N m or N; kinetic_d_dtheta (n), N m s or N s; potential_d_theta (n), N m or N. */
mozzi_status mozzi_energy_gradients(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                    const double *dtheta, const mozzi_environment *environment,
                                    double *kinetic_d_theta, double *kinetic_d_dtheta, double *potential_d_theta);

/* wᵀ∂𝒱_b/∂θ along the velocities, and J_bᵀw: the gradient of wᵀ𝒱_b, the twist of a frame in its own coordinates.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; w (6), any. frame: of this model.
 * Gives d_theta (n), any; d_dtheta (n), any. */
mozzi_status mozzi_frame_twist_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                   const double *dtheta, const double *w, mozzi_frame frame, double *d_theta,
                                   double *d_dtheta);

/* wᵀ∂a_b/∂θ along the velocities, wᵀ∂a_b/∂θ̇ and J_bᵀw: the gradient of wᵀa_b, a_b the acceleration of a frame.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; w (6), any. frame: of this model.
 * Gives d_theta (n), any; d_dtheta (n), any; d_ddtheta (n), any. */
mozzi_status mozzi_frame_acceleration_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                          const double *dtheta, const double *ddtheta, const double *w,
                                          mozzi_frame frame, double *d_theta, double *d_dtheta, double *d_ddtheta);

/* wᵀ∂h/∂θ along the velocities, and wᵀ∂h/∂θ̇: the gradient of wᵀh, h the momentum about a point of {s}.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; w (6), any. about (3): a point of {s}, m, or NULL for its origin.
 * Gives d_theta (n), any; d_dtheta (n), any. */
mozzi_status mozzi_momentum_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                const double *dtheta, const double *w, const double *about, double *d_theta,
                                double *d_dtheta);

/* wᵀ∂ḣ/∂θ along the velocities, wᵀ∂ḣ/∂θ̇ and wᵀ∂ḣ/∂θ̈: the gradient of wᵀḣ, ḣ the rate of the momentum.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; w (6), any. about (3): a point of {s},
 * m, or NULL for its origin.
 * Gives d_theta (n), any; d_dtheta (n), any; d_ddtheta (n), any. */
mozzi_status mozzi_momentum_rate_vjp(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                     const double *dtheta, const double *ddtheta, const double *w, const double *about,
                                     double *d_theta, double *d_dtheta, double *d_ddtheta);

/* ∂g/∂θ.
 * theta (nq), rad or m. environment: or NULL for the model's own.
 * Gives dg (n × n), N m or N, each per unit of its column. */
mozzi_status mozzi_gravity_forces_derivative(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                             const mozzi_environment *environment, mozzi_matrix dg);

/* ∂(JᵀF)/∂θ of the wrenches that frames apply to the environment.
 * theta (nq), rad or m. environment: or NULL for the model's own.
 * Gives dtau (n × n), N m or N, each per unit of its column. */
mozzi_status mozzi_tip_forces_derivative(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                         const mozzi_environment *environment, mozzi_matrix dtau);

/* ∂(M(θ)x)/∂θ for a constant x.
 * theta (nq), rad or m; x (n), any.
 * Gives dMx (n × n), that of M x, each per unit of its column. */
mozzi_status mozzi_mass_matrix_product_derivative(const mozzi_model *model, mozzi_workspace *workspace,
                                                  const double *theta, const double *x, mozzi_matrix dMx);

/* c, the centre of mass of all that moves, in {s}.
 * theta (nq), rad or m.
 * Gives c (3), m. */
mozzi_status mozzi_center_of_mass(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                  double *c);

/* ċ of the centre of mass, in the axes of {s}.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives dc (3), m/s. */
mozzi_status mozzi_center_of_mass_velocity(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                           const double *dtheta, double *dc);

/* c̈ of the centre of mass, in the axes of {s}.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s².
 * Gives ddc (3), m/s². */
mozzi_status mozzi_center_of_mass_acceleration(const mozzi_model *model, mozzi_workspace *workspace,
                                               const double *theta, const double *dtheta, const double *ddtheta,
                                               double *ddc);

/* J of the centre of mass: ċ = Jθ̇, in the axes of {s}.
 * theta (nq), rad or m.
 * Gives J (3 × n), m or 1. */
mozzi_status mozzi_center_of_mass_jacobian(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                           mozzi_matrix J);

/* h, the momentum (angular, linear) of all that moves, about a point of {s}, in the axes of {s}.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. about (3): a point of {s}, m, or NULL for its origin.
 * Gives h (6), kg m²/s, kg m/s. */
mozzi_status mozzi_momentum(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                            const double *dtheta, const double *about, double *h);

/* ḣ of the momentum about a fixed point of {s}, along a motion.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². about (3): a point of {s}, m, or NULL
 * for its origin.
 * Gives dh (6), N m, N. */
mozzi_status mozzi_momentum_rate(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                 const double *dtheta, const double *ddtheta, const double *about, double *dh);

/* A_G(θ), angular rows first: h_G = A_Gθ̇ is the momentum about the centre of mass.
 * theta (nq), rad or m.
 * Gives A (6 × n), kg m² or kg m, kg m or kg. */
mozzi_status mozzi_centroidal_momentum_matrix(const mozzi_model *model, mozzi_workspace *workspace,
                                              const double *theta, mozzi_matrix A);

/* Ȧ_Gθ̇, of ḣ_G = A_Gθ̈ + Ȧ_Gθ̇.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s.
 * Gives b (6), N m, N. */
mozzi_status mozzi_centroidal_momentum_bias(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                            const double *dtheta, double *b);

/* Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π the robot's parameters.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². environment: or NULL for the model's
 * own.
 * Gives Y (n × p), N m or N, each per unit of its parameter. */
mozzi_status mozzi_regressor(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                             const double *dtheta, const double *ddtheta, const mozzi_environment *environment,
                             mozzi_matrix Y);

/* the rows that give the kinetic and the potential energy of the parameters π.
 * theta (nq), rad or m; dtheta (n), rad/s or m/s. environment: or NULL for the model's own.
 * Gives kinetic (p), J, each per unit of its parameter; potential (p), J, each per unit of its parameter. */
mozzi_status mozzi_energy_regressors(const mozzi_model *model, mozzi_workspace *workspace, const double *theta,
                                     const double *dtheta, const mozzi_environment *environment, double *kinetic,
                                     double *potential);

/* End of the quantities. */

/* ---------------------------------------------------------------------------------------- quantities by name */

size_t mozzi_quantity_count(void);
/* NULL for a number that no quantity has. */
const char *mozzi_quantity_name(int32_t quantity);
const char *mozzi_quantity_formula(int32_t quantity);
mozzi_status mozzi_quantity_named(const char *name, int32_t *quantity);
size_t mozzi_quantity_input_count(int32_t quantity);
size_t mozzi_quantity_output_count(int32_t quantity);
/* The length of input k for this model. */
size_t mozzi_quantity_input_length(const mozzi_model *model, int32_t quantity, size_t k);
/* The number of axes of output k, 0 to 3, and their sizes, followed by ones; `task_rows` is the number of rows if it is
 * a task's, 0 for all six. */
mozzi_status mozzi_quantity_output_shape(const mozzi_model *model, int32_t quantity, size_t k, size_t task_rows,
                                         size_t *axes, size_t sizes[3]);

/* An input and its length. */
typedef struct mozzi_input {
    const double *data;
    size_t length;
} mozzi_input;

/* An output, its number of entries, and the strides of its last three axes; those of a vector are {0, 0, 1}. Zeros are
 * by rows, without gaps. */
typedef struct mozzi_output {
    double *data;
    size_t length;
    ptrdiff_t strides[3];
} mozzi_output;

/* Any quantity by its number, lengths checked; in real time. `subject` may be NULL for one of the robot alone. */
mozzi_status mozzi_compute(const mozzi_model *model, mozzi_workspace *workspace, int32_t quantity,
                           const mozzi_subject *subject, const mozzi_input *inputs, size_t input_count,
                           const mozzi_environment *environment, const mozzi_output *outputs, size_t output_count);

/* --------------------------------------------------------------------------------------------- many states */

/* On this many threads, 0 for all cores; with 1, the caller's thread does the work. */
mozzi_status mozzi_batch_new(const mozzi_model *model, size_t threads, mozzi_batch **batch);
/* Likewise, never by machine code: a batch makes it as soon as that pays, which changes the last digits once. */
mozzi_status mozzi_batch_kernels_only(const mozzi_model *model, size_t threads, mozzi_batch **batch);
mozzi_status mozzi_batch_with_program(const mozzi_program *program, size_t threads, mozzi_batch **batch);
mozzi_status mozzi_batch_free(mozzi_batch *batch);

/* For each state a wrench (m, f) of this frame: states × 6 numbers. */
typedef struct mozzi_batch_wrench {
    mozzi_frame frame;
    const double *F;
} mozzi_batch_wrench;

/* What surrounds the robots; NULL, for all or for a part, is the model's own. */
typedef struct mozzi_batch_environment {
    const double *gravity;            /* 3 numbers, the same for all states */
    const double *gravity_of_each;    /* states × 3 */
    const double *parameters_of_each; /* states × p */
    const mozzi_batch_wrench *wrenches;
    size_t wrench_count;
} mozzi_batch_environment;

/* A table of the batch: the numbers of one state after those of the other. */
typedef struct mozzi_table {
    const double *data;
    size_t length;
} mozzi_table;
typedef struct mozzi_table_out {
    double *data;
    size_t length;
} mozzi_table_out;

/* A quantity at many states: `inputs` and `outputs` in the order of the typed function, matrices by rows. Arrays must
 * not overlap. Allocates. */
mozzi_status mozzi_batch_compute(const mozzi_batch *batch, int32_t quantity, const mozzi_subject *subject,
                                 size_t states, const mozzi_table *inputs, size_t input_count,
                                 const mozzi_batch_environment *environment, const mozzi_table_out *outputs,
                                 size_t output_count);

/* ---------------------------------------------------------------------------------------------- simulation */

enum {
    MOZZI_RUNGE_KUTTA_4 = 0,
    MOZZI_EULER = 1,
    MOZZI_SEMI_IMPLICIT_EULER = 2,
    MOZZI_DORMAND_PRINCE = 3, /* adaptive */
    MOZZI_MIDPOINT = 4,       /* implicit, symplectic */
    MOZZI_MOREAU = 5,         /* Moreau and Jean's, for dry friction and limits that are respected */
    MOZZI_AUTOMATIC = 6       /* MOZZI_MOREAU for a robot with dry friction or limits that are respected, else RK4 */
};
enum { MOZZI_LIMITS_IGNORE = 0, MOZZI_LIMITS_REPORT = 1, MOZZI_LIMITS_RESPECT = 2 };

/* Replaces the states of many robots, θ (states × nq) and θ̇ (states × n), by those after `steps` steps in `duration`
 * seconds under constant torques; the method is explicit, with fixed steps, which excludes robots with dry friction.
 * Arrays must not overlap. */
mozzi_status mozzi_batch_simulate(const mozzi_batch *batch, size_t states, double *theta, double *dtheta,
                                  const double *tau, const mozzi_batch_environment *environment, int32_t method,
                                  double duration, size_t steps);

typedef struct mozzi_simulation_options {
    double duration;      /* s */
    size_t steps;         /* of equal length; the interval of rows for an adaptive method */
    size_t record_every;  /* every k-th step is recorded, and the last */
    int32_t method;       /* MOZZI_AUTOMATIC, … */
    int32_t joint_limits; /* MOZZI_LIMITS_… */
    double tolerance;     /* of MOZZI_DORMAND_PRINCE */
    double slip_speed;    /* 0 for dry friction, which MOZZI_MOREAU computes; else μ tanh(θ̇ / slip_speed), rad/s or
                             m/s, for every method */
    const double *gravity; /* 3 numbers in place of the model's, or NULL */
} mozzi_simulation_options;
/* The automatic method, every step recorded, limits reported. */
mozzi_status mozzi_simulation_defaults(double duration, size_t steps, mozzi_simulation_options *options);

/* A row of a motion; arrays live during the call. Energies and works since the start, J. */
typedef struct mozzi_sample {
    double t;
    const double *theta;
    const double *dtheta;
    const double *ddtheta;
    const double *tau;
    double kinetic_energy;
    double potential_energy;
    double motor_work;
    double friction_loss;
    double applied_work;
} mozzi_sample;

/* Adds the motors' torques at time t to tau, n numbers that are 0; another result than 0 ends the simulation with
 * MOZZI_CALLBACK. Neither callback may throw or jump out. */
typedef int32_t (*mozzi_torque)(void *user, double t, const double *theta, const double *dtheta, double *tau);
/* Takes a row; another result than 0 ends the simulation there, with MOZZI_OK. */
typedef int32_t (*mozzi_record)(void *user, const mozzi_sample *sample);

typedef struct mozzi_ending {
    size_t steps;               /* taken */
    int32_t complete;           /* 1 if it reached the end */
    size_t stops;               /* joints that reached a limit */
    double constraint_residual; /* the largest violation of the constraints, rad or m */
} mozzi_ending;

/* The motion from (θ, θ̇); `program`, `torque`, `record`, `user` and `ending` may be NULL. */
mozzi_status mozzi_simulate(const mozzi_model *model, const mozzi_program *program,
                            const mozzi_simulation_options *options, const double *theta, const double *dtheta,
                            mozzi_torque torque, mozzi_record record, void *user, mozzi_ending *ending);

/* -------------------------------------------------------------------------------------- inverse kinematics */

enum { MOZZI_LEVENBERG_MARQUARDT = 0, MOZZI_NEWTON = 1 };

typedef struct mozzi_inverse_kinematics_options {
    int32_t method;        /* MOZZI_LEVENBERG_MARQUARDT or MOZZI_NEWTON */
    int32_t ignore_limits; /* 1: joints may leave their limits */
    double angle;          /* tolerance, rad */
    double distance;       /* tolerance, m */
    size_t iterations;     /* at most, of one start */
    size_t starts;         /* at most: the guess, then random positions */
    uint64_t seed;
    double length; /* that counts as much as a radian, m */
} mozzi_inverse_kinematics_options;
mozzi_status mozzi_inverse_kinematics_defaults(mozzi_inverse_kinematics_options *options);

/* `options` may be NULL. */
mozzi_status mozzi_inverse_kinematics_new(const mozzi_model *model, mozzi_frame frame,
                                          const mozzi_inverse_kinematics_options *options,
                                          mozzi_inverse_kinematics **solver);
mozzi_status mozzi_inverse_kinematics_free(mozzi_inverse_kinematics *solver);

enum {
    MOZZI_GOAL_POSE = 0,       /* T_sb, 4 × 4 by rows */
    MOZZI_GOAL_POSITION = 1,   /* the frame's origin, 3 numbers */
    MOZZI_GOAL_ORIENTATION = 2 /* R_sb, 3 × 3 by rows */
};

typedef struct mozzi_solution {
    double angle;    /* that is left, rad; NaN if the goal leaves it free */
    double distance; /* that is left, m; likewise */
    size_t starts;
    size_t iterations;
} mozzi_solution;

/* Positions that reach the goal, from a guess; among several, the nearest to `near`, unless that is NULL. `solution` may
 * be NULL. A floating base moves, too: load the robot with a fixed one to hold it. */
mozzi_status mozzi_inverse_kinematics_solve(mozzi_inverse_kinematics *solver, int32_t kind, const double *goal,
                                            const double *guess, const double *near_theta, double *theta,
                                            mozzi_solution *solution);

#ifdef __cplusplus
}
#endif

#endif
