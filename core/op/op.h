/* op.h - the operation table: one row for each edit, with all that the program knows about the
 * edit.
 *
 * The rows drive the decoding of JSON bodies, GET /v1/operations, the OpenAPI schemas, the viewer's
 * tool panel, fuzzing, and the duties of the tests. For every row, tests must produce a success and
 * each refusal that the row declares, and no other refusal. V, E and F must change as declared, the
 * checker must pass, and a refusal must leave the mesh bit-identical.
 *
 * The name of a row is also the name of its C function (he_edge_split for edge_split) and occurs in
 * the names of its tests. */
#ifndef HE_OP_OP_H
#define HE_OP_OP_H

#include "mesh/mesh.h"

/* The type of a parameter. */
typedef enum he_param_type {
    HE_PARAM_ELEMENT,  /* the id of one element, of the kind that the parameter's row names */
    HE_PARAM_ELEMENTS, /* one id under the key `name`, or a list of ids under the key `plural` */
    HE_PARAM_NUMBER,   /* a finite double, within min and max where the row has a range */
    HE_PARAM_POINT,    /* a point [x, y, z] */
    HE_PARAM_POINTS,   /* a point [x, y, z], or a list of points, one for each element */
    HE_PARAM_FLAG,     /* true or false */
    HE_PARAM_CHOICE,   /* one of the strings in `choices` */
    /* 16 numbers, row-major; the last row is 0 0 0 1 unless the flag HE_PROJECTIVE is set */
    HE_PARAM_MATRIX,
    HE_PARAM_POLYGON, /* a list of points [x, y], the corners of a polygon in a plane */
    HE_PARAM_CYCLE,   /* a list of element ids whose order matters; repeated ids are refused */
    HE_PARAM_TEXT,    /* a string */
    /* red, green and blue, none below 0; with the flag HE_OPACITY a fourth number, the opacity, may
     * follow */
    HE_PARAM_COLOR,
    HE_PARAM_MESH /* another mesh, which must not change while the operation runs */
} he_param_type;

/* Flags of a parameter. */
enum {
    HE_REQUIRED = 1,
    HE_NULLABLE = 2,  /* the element may be null in a request; the operation then gets HE_NONE */
    HE_EXCLUSIVE = 4, /* the number may equal neither `min` nor `max` */
    HE_RANGE = 8,     /* the number must be from `min` to `max` */
    HE_DERIVED = 16,  /* a number or flag whose default is computed from the mesh, as `doc` says */
    /* If a request gives this parameter, even an HE_OP_LOCAL operation takes time linear in the
     * whole mesh. */
    HE_COSTS_MESH = 32,
    HE_WHOLE = 128, /* a number with a range; only whole numbers are allowed */
    /* The operation also visits neighbours of the elements: all corners of the faces around a
     * vertex, all edges at the corners of a face or along a loop, both loops of an edge. */
    HE_REACHES = 64,
    /* The operation walks around each element that this parameter names: around a vertex, or along
     * the loop of a face or hole; with HE_REACHES also around all corners of the adjacent faces.
     * These walks count towards the work limit of a request that has a list of operations, because
     * such a request may name a vertex of large degree again and again. */
    HE_WALKS = 256,
    HE_OPACITY = 512, /* a colour may have an opacity as its fourth number */
    /* The selector of the operation: a choice on which depends which other parameters may be given,
     * see `with`. An operation has at most one, before the parameters that depend on it. */
    HE_SELECTS = 1024,
    /* The operation also runs if this list of elements is empty. Without this flag he_op_run then
     * does nothing. */
    HE_MAY_BE_EMPTY = 2048,
    HE_PROJECTIVE = 4096 /* the last row of the matrix may be any four numbers */
};

/* The bit of a value of the selector in `with` and `needed` of a parameter. */
#define HE_WITH(choice) (1u << (choice))

/* The unit of angles. */
#define HE_RADIANS "radians"

typedef struct he_param {
    const char *name;
    /* The name of the member of a request that gives a list; NULL unless `type` is
     * HE_PARAM_ELEMENTS. */
    const char *plural;
    /* The name of the member of a request that gives a list for this HE_PARAM_ELEMENT,
     * HE_PARAM_POINT or HE_PARAM_CYCLE; NULL if there is none. It may be equal to `name`. The
     * operation then runs once for each item of the list, in order, and its other parameters may be
     * columns (he_arg). An operation that takes such lists has no HE_PARAM_ELEMENTS. */
    const char *each;
    he_param_type type;
    he_kind kind; /* kind of the elements */
    unsigned flags;
    /* Parameters that have the same letter here are alternatives: at most one of them is given, and
     * exactly one if any of them is required. 0: the parameter has no alternatives. */
    char group;
    /* The values of the selector with which the parameter may be given, as bits (HE_WITH); 0: with
     * all. */
    unsigned with;
    /* Those of them with which the parameter, or one of its alternatives, must be given. A
     * parameter that has HE_REQUIRED must be given with all. */
    unsigned needed;
    double min, max;
    double fallback;            /* default of a number; 0 or 1 for a flag; index of a choice */
    const char *unit;           /* the unit of a number, such as HE_RADIANS; NULL: none */
    const char *const *choices; /* names of the choices, ending in NULL */
    const char *doc;
} he_param;

/* A decoded argument of an operation, at the index of its parameter. Lists are borrowed for the
 * call.
 *
 * If the argument of a parameter with `each` is a list, the operation runs once for each item, and
 * the argument of another parameter is either one value for all runs or a column: a list with one
 * value for each run. A column of elements is in `ids`, a column of points in `points`, a column of
 * numbers, flags (0 or 1) or choices in `numbers`. The selector of an operation is no column. */
typedef struct he_arg {
    bool given;
    uint32_t id;         /* value of an HE_PARAM_ELEMENT; HE_NONE for null */
    const uint32_t *ids; /* values of an HE_PARAM_ELEMENTS or HE_PARAM_CYCLE */
    size_t count;        /* number of ids, points, corners or, in a column, values */
    /* true if an HE_PARAM_ELEMENTS or HE_PARAM_POINTS was given as a list; true for a column and
     * for the list that decides how often the operation runs */
    bool list;
    double number;
    const double *numbers; /* the values of a column of numbers, flags or choices */
    /* If an HE_PARAM_CYCLE was given as a list of `rows` lists: where each of them ends in `ids`.
     * Else NULL. */
    const uint32_t *ends;
    size_t rows;
    /* Values of an HE_PARAM_POINT or HE_PARAM_POINTS; values of an HE_PARAM_POLYGON, with z = 0. */
    const he_vec3 *points;
    bool flag;
    int choice;
    double matrix[16];
    const char *text; /* value of an HE_PARAM_TEXT; borrowed */
    /* The value of an HE_PARAM_COLOR: `count` numbers (3 or 4); the rest of the array is not
     * used. */
    double color[4];
    const he_mesh *mesh; /* value of an HE_PARAM_MESH; borrowed; never the mesh that is edited */
} he_arg;

/* The type of a result. Every operation also reports which elements it made, changed and deleted;
 * that report follows from the delta (the log of writes) and is not declared here. */
typedef enum he_result_type {
    HE_RESULT_ELEMENT,  /* one id, or null */
    HE_RESULT_ELEMENTS, /* a list of ids */
    HE_RESULT_NUMBER,
    HE_RESULT_MAP,    /* the new id of each old id, null if the element was deleted */
    HE_RESULT_COUNTS, /* the number of elements of one kind after each step of subdivision */
    HE_RESULT_CHOICE  /* one of the strings in `choices` */
} he_result_type;

typedef struct he_result_row {
    const char *name;
    he_result_type type;
    he_kind kind;
    const char *doc;
    const char *const *choices; /* names of the choices, ending in NULL */
    const char *unit;           /* the unit of a number, such as HE_RADIANS; NULL: none */
} he_result_row;

enum { HE_OP_PARAMS = 24, HE_OP_RESULTS = 12, HE_OP_REFUSALS = 16 };

/* The results of an operation: result i of the operation's row is in entry i of these arrays.
 * he_op_run clears the arrays and fills them; the caller clears them when they are no longer
 * needed. {0} is empty.
 *
 * If the operation ran once for each item of a list, `each` is true, and every result is a column
 * with `runs` values: the ids of an HE_RESULT_ELEMENT are list[i], in order, HE_NONE for null; the
 * lists of an HE_RESULT_ELEMENTS follow each other in list[i], and ends[i] says where each of them
 * ends; the values of an HE_RESULT_NUMBER are numbers[i], NaN for a result that a run left out. */
typedef struct he_results {
    bool present[HE_OP_RESULTS];
    /* Value of an HE_RESULT_ELEMENT, or the index of an HE_RESULT_CHOICE. */
    uint32_t id[HE_OP_RESULTS];
    he_ids list[HE_OP_RESULTS];
    double number[HE_OP_RESULTS];
    bool each;
    size_t runs;
    he_ids ends[HE_OP_RESULTS];
    double *numbers[HE_OP_RESULTS];
} he_results;

/* Says what the time of an operation depends on: the number of elements that it touches
 * (HE_OP_LOCAL), or the size of the whole mesh (HE_OP_WHOLE). */
typedef enum he_op_size { HE_OP_LOCAL, HE_OP_WHOLE } he_op_size;

/* Stands for a change of V, E or F that depends on the mesh. */
enum { HE_VARIES = -1000 };

typedef struct he_op {
    const char *name;
    const char *doc; /* one sentence */
    he_op_size size;
    he_param params[HE_OP_PARAMS]; /* the list ends at the first parameter without a name */
    he_result_row results[HE_OP_RESULTS];
    /* Every refusal that the operation can give, in addition to HE_NO_MEMORY, HE_IDS_EXHAUSTED and,
     * if the work can be cancelled, HE_CANCELLED; the list ends in HE_OK. */
    he_status refusals[HE_OP_REFUSALS];
    int change[3]; /* change of the numbers of vertices, edges and faces, in this order */
    /* The measured time for one element, relative to that of `transform`, rounded up. Elements are
     * those of the mesh if the operation is HE_OP_WHOLE, else those in the lists of its arguments.
     * 0 means 1. */
    unsigned pace;
    /* Returns how often the operation does with these arguments what `pace` is the time of; NULL:
     * once. */
    unsigned (*times)(const he_arg *args);
    /* Returns the approximate factor by which the mesh grows, at least 1; NULL if the mesh keeps
     * its size, or an HE_OP_LOCAL operation makes no more elements than it touches. `mesh` is NULL
     * if it is not known yet. Takes no longer for a large mesh. */
    double (*growth)(const he_mesh *mesh, const he_arg *args);
    /* Finds out, from the mesh's numbers of elements alone, whether the operation will be refused.
     * HE_OK does not mean that the operation will succeed. NULL if the operation has no such
     * check. */
    he_status (*foresee)(const he_mesh *mesh, const he_arg *args, he_error *err);
    /* Performs the operation. Only he_op_run calls it. */
    he_status (*run)(he_mesh *mesh, const he_arg *args, he_results *out, he_error *err);
} he_op;

size_t he_op_count(void);
const he_op *he_op_at(size_t i);
size_t he_op_number(const he_op *op); /* returns the number i for which he_op_at(i) is `op` */
/* Returns the operation with this name, or NULL if there is none. */
const he_op *he_op_find(const char *name, size_t length);
size_t he_op_params(const he_op *op);
size_t he_op_results(const he_op *op);
/* Returns the operation's selector, the parameter with the flag HE_SELECTS, or NULL if it has
 * none. */
const he_param *he_op_selector(const he_op *op);
/* These functions say whether parameter `i` of the operation may be given, and whether it or one of
 * its alternatives must be given, with the value that the selector has in `args`. */
bool he_op_takes(const he_op *op, const he_arg *args, size_t i);
bool he_op_needs(const he_op *op, const he_arg *args, size_t i);
/* Returns the parameter that was given as a list for each of whose items the operation runs, or
 * NULL if it runs once. */
const he_param *he_op_each(const he_op *op, const he_arg args[HE_OP_PARAMS]);
/* Returns how often the operation runs: 1 if he_op_each returns NULL. */
size_t he_op_runs(const he_op *op, const he_arg args[HE_OP_PARAMS]);
/* Returns true if a parameter may be given as a column if the operation runs once for each item of
 * a list. */
bool he_op_is_column(const he_param *param);
/* Returns true if the operation, with these arguments, takes time linear in the whole mesh. */
bool he_op_is_whole(const he_op *op, const he_arg args[HE_OP_PARAMS]);
/* Returns the approximate factor by which the operation makes the mesh grow; 1 if the mesh keeps
 * its size. `mesh` may be NULL, if it is not known yet: then the factor is what the arguments alone
 * tell. */
double he_op_growth(const he_op *op, const he_mesh *mesh, const he_arg args[HE_OP_PARAMS]);
/* Returns the operation's time for one element, with these arguments, relative to that of
 * `transform`, but at least 1. */
unsigned he_op_pace(const he_op *op, const he_arg args[HE_OP_PARAMS]);
/* Finds out, from the mesh's numbers of elements alone, whether the operation will be refused.
 * HE_OK does not mean that the operation will succeed. */
HE_NODISCARD he_status he_op_foresee(const he_op *op, const he_mesh *mesh,
                                     const he_arg args[HE_OP_PARAMS], he_error *err);
/* Returns true if the row declares this refusal, or if the status means success, cancellation or a
 * lack of memory or ids, which rows do not declare. */
bool he_op_declares(const he_op *op, he_status status);

/* Fills in an argument for every parameter: the parameter's default, with `given` false. */
void he_op_defaults(const he_op *op, he_arg args[HE_OP_PARAMS]);
/* Applies one operation. The caller fills `args` by he_op_defaults and then replaces the arguments
 * that were given. It must have checked ranges, groups, the selector and finiteness; this is
 * asserted. If the operation is refused, the mesh does not change. If a list of elements without
 * the flag HE_MAY_BE_EMPTY is empty, the mesh does not change either, and the results are null, 0
 * and empty lists.
 *
 * If he_op_each returns a parameter, the operation runs once for each item of its list, in order,
 * and the runs stand or fall together: a refusal of one of them undoes those before it, and
 * out->runs is then the index of the item at which it was refused. No item may occur twice in a
 * list of elements, and all columns must be as long as the list; this is not checked. */
HE_NODISCARD he_status he_op_run(const he_op *op, he_mesh *mesh, const he_arg args[HE_OP_PARAMS],
                                 he_results *out, he_error *err);
void he_results_clear(he_results *results);

#endif
