/* Checks of the test programs: a failure prints its place and ends the program. */
#ifndef CHECK_H
#define CHECK_H

#include "mozzi/mozzi.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                                   \
    do {                                                                                                   \
        if (!(condition)) {                                                                                \
            fprintf(stderr, "%s:%d: not %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                                                       \
        }                                                                                                  \
    } while (0)

/* Checks that a call returns this status, and that a failure has a text. */
#define EXPECT(status, call)                                                                               \
    do {                                                                                                   \
        const mozzi_status found_ = (call);                                                                \
        if (found_ != (status)) {                                                                          \
            fprintf(stderr, "%s:%d: %s is %d (%s), expected %s; last error: %s\n", __FILE__, __LINE__, #call, (int)found_, \
                    mozzi_status_text(found_), #status, mozzi_last_error());                               \
            exit(1);                                                                                       \
        }                                                                                                  \
        if (found_ != MOZZI_OK) {                                                                          \
            CHECK(strlen(mozzi_last_error()) > 0);                                                         \
        }                                                                                                  \
    } while (0)

#define OK(call) EXPECT(MOZZI_OK, call)

/* The largest difference, relative to the largest of the expected numbers and 1. */
static inline double difference(const double *found, const double *expected, size_t count) {
    double most = 1.0, difference = 0.0;
    size_t k;
    for (k = 0; k < count; ++k) {
        most = fmax(most, fabs(expected[k]));
    }
    for (k = 0; k < count; ++k) {
        const double d = fabs(found[k] - expected[k]);
        difference = d > difference || d != d ? d : difference;
    }
    return difference / most;
}

#endif
