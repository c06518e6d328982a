/* Threads with workspaces of their own, threads that share one, and forks. */
#include "state.h"

#include "calls.inc"

#include <pthread.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

enum { THREADS = 2, ROUNDS = 300 };

struct worker {
    struct robot *robot;
    mozzi_workspace *workspace;
    int may_be_busy;
    size_t computed, busy;
};

/* Every quantity into arrays of this thread's own, compared with the expected numbers. */
static void *work(void *given) {
    struct worker *worker = (struct worker *)given;
    size_t round, q, k;
    for (round = 0; round < ROUNDS; ++round) {
        for (q = 0; q < worker->robot->count; q += 5) {
            struct arguments a = worker->robot->quantities[q];
            mozzi_status status;
            a.workspace = worker->workspace;
            for (k = 0; k < a.output_count; ++k) {
                a.out[k] = (double *)malloc((a.out_length[k] + 1) * sizeof(double));
                CHECK(a.out[k] != NULL);
            }
            status = typed[q](&a);
            if (status == MOZZI_BUSY && worker->may_be_busy) {
                CHECK(strstr(mozzi_last_error(), "in use") != NULL);
                ++worker->busy;
            } else {
                CHECK(status == MOZZI_OK);
                check_outputs(&a, 1e-10);
                ++worker->computed;
            }
            for (k = 0; k < a.output_count; ++k) {
                free(a.out[k]);
            }
        }
    }
    return NULL;
}

static void run(struct robot *robot, int share) {
    struct worker workers[THREADS];
    pthread_t threads[THREADS];
    size_t k, computed = 0;
    for (k = 0; k < THREADS; ++k) {
        struct worker *worker = &workers[k];
        memset(worker, 0, sizeof *worker);
        worker->robot = robot;
        worker->may_be_busy = share;
        worker->workspace = robot->workspace;
        if (!share) {
            OK(mozzi_workspace_new(robot->model, &worker->workspace));
        }
        CHECK(pthread_create(&threads[k], NULL, work, worker) == 0);
    }
    for (k = 0; k < THREADS; ++k) {
        CHECK(pthread_join(threads[k], NULL) == 0);
        computed += workers[k].computed;
        CHECK(share || workers[k].busy == 0);
        if (!share) {
            OK(mozzi_workspace_free(workers[k].workspace));
        }
    }
    CHECK(computed > 0);
}

/* 64 states of gravity forces; compares with the workspace's. */
static mozzi_status many(mozzi_batch *batch, struct robot *robot) {
    const struct arguments *a = &robot->quantities[MOZZI_MASS_MATRIX];
    const size_t states = 640, nq = a->in_length[0], n = mozzi_model_n(robot->model);
    double *theta = (double *)malloc(states * nq * sizeof *theta), *M = (double *)calloc(states * n * n, sizeof *M);
    mozzi_table in;
    mozzi_table_out out;
    size_t k;
    mozzi_status status;
    CHECK(theta != NULL && M != NULL);
    for (k = 0; k < states; ++k) {
        memcpy(theta + k * nq, a->in[0], nq * sizeof *theta);
    }
    in.data = theta;
    in.length = states * nq;
    out.data = M;
    out.length = states * n * n;
    status = mozzi_batch_compute(batch, MOZZI_MASS_MATRIX, NULL, states, &in, 1, NULL, &out, 1);
    for (k = 0; k < states && status == MOZZI_OK; ++k) {
        CHECK(difference(M + k * n * n, a->expected[0], n * n) < 1e-10);
    }
    free(theta);
    free(M);
    return status;
}

static void forks(struct robot *robot) {
    mozzi_batch *batch = NULL, *of_child = NULL;
    pid_t child;
    int status = -1;
    OK(mozzi_batch_new(robot->model, 2, &batch));
    OK(many(batch, robot)); /* its threads run */
    child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        struct worker worker;
        memset(&worker, 0, sizeof worker);
        worker.robot = robot;
        worker.workspace = robot->workspace;
        work(&worker);
        CHECK(worker.computed > 0);
        EXPECT(MOZZI_FORKED, many(batch, robot));
        OK(mozzi_batch_free(batch)); /* does not wait for threads that are not there */
        OK(mozzi_batch_new(robot->model, 2, &of_child));
        OK(many(of_child, robot));
        OK(mozzi_batch_free(of_child));
        OK(mozzi_batch_new(robot->model, 0, &of_child));
        OK(many(of_child, robot));
        OK(mozzi_batch_free(of_child));
        _exit(0);
    }
    CHECK(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    OK(many(batch, robot));
    OK(mozzi_batch_free(batch));
}

int main(int count, char **arguments) {
    FILE *file;
    struct robot robot;
    CHECK(count == 2);
    file = fopen(arguments[1], "r");
    CHECK(file != NULL);
    while (next_robot(file, &robot)) {
        run(&robot, 0);
        run(&robot, 1);
        forks(&robot);
        free_robot(&robot);
    }
    fclose(file);
    return 0;
}
