/* A million calls at one state, of every quantity by kernels and by machine code, allocate nothing. */
#include "state.h"

#include "calls.inc"

#include <pthread.h>


/* The allocator of the C library, counted: the shared library calls these functions, too. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *at, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *at);

static volatile size_t calls;

void *malloc(size_t size) {
    ++calls;
    return __libc_malloc(size);
}
void *calloc(size_t count, size_t size) {
    ++calls;
    return __libc_calloc(count, size);
}
void *realloc(void *at, size_t size) {
    ++calls;
    return __libc_realloc(at, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
    ++calls;
    return __libc_memalign(alignment, size);
}
int posix_memalign(void **at, size_t alignment, size_t size) {
    ++calls;
    *at = __libc_memalign(alignment, size);
    return *at == NULL;
}
void free(void *at) {
    calls += at != NULL;
    __libc_free(at);
}

enum { CALLS = 1000000 };

/* As many calls of every quantity, in all orders; how many calls they were. */
static size_t run(struct robot *robot, size_t rounds) {
    size_t done = 0, round, q;
    size_t rows[6] = {0, 1, 2, 3, 4, 5};
    mozzi_task task = robot->task;
    for (round = 0; round < rounds; ++round) {
        for (q = 0; q < robot->count; ++q) {
            struct arguments *a = &robot->quantities[q];
            a->by_columns = (int)(round & 1);
            a->environment = round & 2 ? &robot->environment : NULL;
            OK(typed[q](a));
            OK(by_number(a));
            done += 2;
        }
        /* tasks of other numbers of rows */
        {
            double *Lambda = robot->quantities[MOZZI_TASK_SPACE_DYNAMICS].out[0];
            double room[42];
            const double *const *in = robot->quantities[MOZZI_TASK_SPACE_DYNAMICS].in;
            mozzi_status status;
            (void)Lambda;
            task.rows = rows;
            task.row_count = 1 + round % 6;
            status = mozzi_task_space_dynamics(robot->model, robot->workspace, in[0], in[1], &task, NULL,
                                               mozzi_by_rows(room, task.row_count), room + 36);
            CHECK(status == MOZZI_OK || status == MOZZI_SINGULAR);
            ++done;
        }
        /* failures */
        EXPECT(MOZZI_NULL, mozzi_gravity_forces(robot->model, robot->workspace, NULL, NULL, NULL));
        OK(mozzi_difference(robot->model, robot->quantities[0].in[0], robot->quantities[0].in[0],
                            robot->quantities[0].out[0]));
        done += 2;
    }
    return done;
}

/* Inverse kinematics from near and far, with a secondary goal, and in vain. */
static void search(void) {
    mozzi_model *model = NULL;
    mozzi_workspace *workspace = NULL;
    mozzi_inverse_kinematics *solver = NULL;
    mozzi_frame hand;
    mozzi_solution solution;
    double theta[16] = {0.3, -0.5, 0.2, -1.8, 0.1, 1.5, 0.4}, guess[16] = {0, 0, 0, -1.5, 0, 1.5, 0};
    double far[16] = {2, 1, -2, -0.5, 2, 0.5, -2}, T[16], found[16];
    const double beyond[3] = {100, 0, 0};
    size_t before, k, starts = 0;
    OK(mozzi_model_embedded("panda", &model));
    OK(mozzi_workspace_new(model, &workspace));
    OK(mozzi_model_frame(model, "panda_hand", &hand));
    OK(mozzi_inverse_kinematics_new(model, hand, NULL, &solver));
    before = calls;
    for (k = 0; k < 20; ++k) {
        theta[0] = 0.1 * (double)k;
        OK(mozzi_forward_kinematics(model, workspace, theta, hand, mozzi_by_rows(T, 4)));
        OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSE, T, guess, NULL, found, &solution));
        OK(mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSE, T, far, k < 2 ? guess : NULL, found, &solution));
        starts += solution.starts;
    }
    EXPECT(MOZZI_NOT_REACHED,
           mozzi_inverse_kinematics_solve(solver, MOZZI_GOAL_POSITION, beyond, guess, NULL, found, NULL));
    CHECK(calls == before);
    CHECK(starts >= 20);
    OK(mozzi_inverse_kinematics_free(solver));
    OK(mozzi_workspace_free(workspace));
    OK(mozzi_model_free(model));
}

int main(int count, char **arguments) {
    FILE *file;
    struct robot robot;
    size_t total = 0;
    CHECK(count == 2);
    {
        /* those of the library are counted */
        mozzi_model *model = NULL;
        const size_t before = calls;
        OK(mozzi_model_embedded("ur5", &model));
        CHECK(calls > before + 100);
        OK(mozzi_model_free(model));
    }
    mozzi_last_error(); /* allocates this thread's memory, if it must */
    search();
    file = fopen(arguments[1], "r");
    CHECK(file != NULL);
    while (next_robot(file, &robot)) {
        int32_t all[256];
        mozzi_subject subjects[256];
        mozzi_program *program = NULL;
        size_t q, before, rounds = CALLS / 4 / 2 / (2 * robot.count + 3) + 1, done;
        int kind;
        for (kind = 0; kind < 2; ++kind) {
            if (kind == 1) {
                for (q = 0; q < robot.count; ++q) {
                    all[q] = (int32_t)q;
                    subjects[q] = subject_of(&robot.quantities[q]);
                }
                OK(mozzi_program_new(robot.model, all, subjects, robot.count, &program));
                OK(mozzi_workspace_free(robot.workspace));
                OK(mozzi_workspace_with_program(program, &robot.workspace));
                OK(mozzi_program_free(program));
                for (q = 0; q < robot.count; ++q) {
                    robot.quantities[q].workspace = robot.workspace;
                }
            }
            before = calls;
            done = run(&robot, rounds);
            if (calls != before) {
                fprintf(stderr, "%s, kind %d: %zu allocations in %zu calls\n", mozzi_model_name(robot.model), kind,
                        (size_t)calls - before, done);
                return 1;
            }
            total += done;
        }
        free_robot(&robot);
    }
    fclose(file);
    CHECK(total >= CALLS);
    printf("0 allocations in %zu calls\n", total);
    return 0;
}
