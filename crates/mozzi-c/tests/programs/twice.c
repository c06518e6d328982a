/* The library opened twice by its name, and a copy of it under another: handles of one are foreign to the other. The
 * library stays after dlclose. */
#include "check.h"

#include <dlfcn.h>

typedef mozzi_status (*embedded)(const char *, mozzi_model **);
typedef mozzi_status (*release)(mozzi_model *);
typedef size_t (*size)(const mozzi_model *);
typedef mozzi_status (*workspace_new)(const mozzi_model *, mozzi_workspace **);

/* ISO C has no conversion from void * to functions; POSIX has this one. */
static void symbol(void *library, const char *name, void *function) {
    void *found = dlsym(library, name);
    CHECK(found != NULL);
    memcpy(function, &found, sizeof found);
}

static void *opened(const char *name) {
    void *library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return library;
}

int main(void) {
    void *first = opened("./libmozzi.so.0"), *second = opened("./libmozzi.so.0"), *copy = opened("./copy-of-mozzi.so");
    embedded make, make_copy;
    release drop, drop_copy;
    size n, n_copy;
    workspace_new new_copy;
    mozzi_model *model = NULL, *other = NULL;
    mozzi_workspace *workspace = NULL;
    CHECK(first == second && copy != first);
    symbol(first, "mozzi_model_embedded", &make);
    symbol(copy, "mozzi_model_embedded", &make_copy);
    symbol(first, "mozzi_model_free", &drop);
    symbol(copy, "mozzi_model_free", &drop_copy);
    symbol(first, "mozzi_model_n", &n);
    symbol(copy, "mozzi_model_n", &n_copy);
    symbol(copy, "mozzi_workspace_new", &new_copy);
    CHECK(make != make_copy);
    CHECK(make("ur5", &model) == MOZZI_OK && make_copy("ur5", &other) == MOZZI_OK);
    CHECK(n(model) == 6 && n_copy(other) == 6);
    CHECK(n(other) == 0 && n_copy(model) == 0);
    CHECK(drop(other) == MOZZI_INVALID_HANDLE && drop_copy(model) == MOZZI_INVALID_HANDLE);
    CHECK(new_copy(model, &workspace) == MOZZI_INVALID_HANDLE && workspace == NULL);
    CHECK(drop_copy(other) == MOZZI_OK);
    CHECK(dlclose(copy) == 0 && dlclose(second) == 0 && dlclose(first) == 0);
    /* as its threads may run on, it was not unloaded */
    CHECK(n(model) == 6);
    CHECK(drop(model) == MOZZI_OK);
    return 0;
}
