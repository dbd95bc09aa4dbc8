/* measure.c - answers questions about measures of one element or of many:
 * {"measure":"dihedral","of":{"edge":3}}.
 *
 * Values are numbers or vectors. A missing value is null in JSON and NaN in a binary answer. */
#include "api/ask/question.h"
#include "api/read/elements.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"
#include "query/curvature.h"

#include <math.h>
#include <string.h>

/* The parameters of a question about a measure, except the elements to measure. */
typedef struct options {
    he_weight weight;
    double crease;
    he_progress *progress; /* the watch of the exchange */
    /* Limit of the work if a question lists its elements: the sum of the squared numbers of corners
     * of the faces around these elements. */
    uint64_t most;
} options;

/* The elements that a question wants to be measured. */
typedef struct selection {
    /* Ids of the elements; NULL: all live elements are measured, in the order of ids. */
    const uint32_t *ids;
    size_t count;
} selection;

typedef struct measure {
    he_kind of;
    const char *name;
    unsigned components;
    enum { PLAIN, WEIGHTS, CREASE } option;
    /* Measures one element; NULL: `many` is called for a single element, too. */
    he_status (*one)(const he_mesh *m, uint32_t id, const options *o, double *out, he_error *err);
    /* Measures many elements. NULL: they are measured one by one. */
    he_status (*many)(const he_mesh *m, const selection *of, const options *o, double *out,
                      he_error *err);
} measure;

static void put(he_vec3 v, double *out)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Copies the values of live elements from `rows`, which has a value for each id, also of a deleted
 * element, to `out` without gaps. */
static void compress(const he_mesh *m, he_kind kind, const he_vec3 *rows, double *out)
{
    for (uint32_t id = 0; id < he_mesh_issued(m, kind); id++) {
        if (he_mesh_is_live(m, kind, id)) {
            put(rows[id], out);
            out += 3;
        }
    }
}

/* --- measures of vertices --- */

static he_status vertex_normal(const he_mesh *m, uint32_t id, const options *o, double *out,
                               he_error *err)
{
    (void)err;
    he_vec3 normal;
    he_vertex_normal(m, (he_vertex){id}, o->weight, &normal);
    put(normal, out);
    return HE_OK;
}

static he_vec3 *rows_new(const he_mesh *m, he_kind kind, he_error *err)
{
    he_vec3 *rows = he_mem_array(NULL, (size_t)he_mesh_issued(m, kind) + 1, sizeof *rows);
    if (rows == NULL) {
        (void)he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of a mesh");
    }
    return rows;
}

static he_status vertex_normals(const he_mesh *m, const selection *of, const options *o,
                                double *out, he_error *err)
{
    (void)of;
    he_vec3 *rows = rows_new(m, HE_VERTEX, err);
    if (rows == NULL) {
        return HE_NO_MEMORY;
    }
    he_status status = he_vertex_normals(m, o->weight, o->progress, rows, err);
    if (status == HE_OK) {
        compress(m, HE_VERTEX, rows, out);
    }
    he_mem_free(rows);
    return status;
}

/* Computes the curvatures of the vertices and writes one kind of them: the member at offset `at` of
 * he_curvature. */
static he_status curvature(const he_mesh *m, const selection *of, const options *o, size_t at,
                           double *out, he_error *err)
{
    he_curvature *all = he_mem_array(NULL, of->count + 1, sizeof *all);
    if (all == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the curvature of %zu vertices",
                             of->count);
    }
    he_status status = he_curvatures(m, of->ids, of->count, o->most, o->progress, all, err);
    for (size_t i = 0; i < of->count && status == HE_OK; i++) {
        memcpy(&out[i], (const char *)&all[i] + at, sizeof out[i]);
    }
    he_mem_free(all);
    return status;
}

#define CURVATURE(name, member)                                                                 \
    static he_status name(const he_mesh *m, const selection *of, const options *o, double *out, \
                          he_error *err)                                                        \
    {                                                                                           \
        return curvature(m, of, o, offsetof(he_curvature, member), out, err);                   \
    }
CURVATURE(vertex_areas, area)
CURVATURE(angle_defects, angle_defect)
CURVATURE(mean_curvatures, mean)
CURVATURE(gaussian_curvatures, gaussian)
#undef CURVATURE

static he_status vertex_degree(const he_mesh *m, uint32_t id, const options *o, double *out,
                               he_error *err)
{
    (void)o, (void)err;
    *out = he_vertex_degree(m, (he_vertex){id});
    return HE_OK;
}

/* --- measures of half-edges, which stand for the corners at their origin --- */

static he_status corner_angle(const he_mesh *m, uint32_t id, const options *o, double *out,
                              he_error *err)
{
    (void)o, (void)err;
    *out = he_corner_angle(m, (he_halfedge){id});
    return HE_OK;
}

static he_status corner_normal(const he_mesh *m, uint32_t id, const options *o, double *out,
                               he_error *err)
{
    he_vec3 normal = {0, 0, 0};
    he_status status = he_corner_normal(m, (he_halfedge){id}, o->crease, &normal, err);
    put(normal, out);
    return status;
}

static he_status corner_normals(const he_mesh *m, const selection *of, const options *o,
                                double *out, he_error *err)
{
    (void)of;
    he_vec3 *rows = rows_new(m, HE_HALFEDGE, err);
    if (rows == NULL) {
        return HE_NO_MEMORY;
    }
    he_status status = he_corner_normals(m, o->crease, o->progress, rows, err);
    if (status == HE_OK) {
        compress(m, HE_HALFEDGE, rows, out);
    }
    he_mem_free(rows);
    return status;
}

/* --- measures of edges --- */

static he_status edge_length(const he_mesh *m, uint32_t id, const options *o, double *out,
                             he_error *err)
{
    (void)o, (void)err;
    *out = he_edge_length(m, (he_edge){id});
    return HE_OK;
}

static he_status dihedral(const he_mesh *m, uint32_t id, const options *o, double *out,
                          he_error *err)
{
    (void)o, (void)err;
    if (!he_edge_dihedral(m, (he_edge){id}, out)) {
        *out = NAN;
    }
    return HE_OK;
}

static he_status dihedrals(const he_mesh *m, const selection *of, const options *o, double *out,
                           he_error *err)
{
    (void)of;
    uint32_t issued = he_mesh_issued(m, HE_EDGE);
    double *rows = he_mem_array(NULL, (size_t)issued + 1, sizeof *rows);
    if (rows == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the dihedral angles of a mesh");
    }
    he_status status = he_edge_dihedrals(m, o->progress, rows, err);
    for (uint32_t e = 0; e < issued && status == HE_OK; e++) {
        if (he_mesh_is_live(m, HE_EDGE, e)) {
            *out++ = rows[e];
        }
    }
    he_mem_free(rows);
    return status;
}

static he_status edge_cotangents(const he_mesh *m, const selection *of, const options *o,
                                 double *out, he_error *err)
{
    return he_edge_cotangents(m, of->ids, of->count, o->most, o->progress, out, err);
}

/* --- measures of faces --- */

static he_status face_normal(const he_mesh *m, uint32_t id, const options *o, double *out,
                             he_error *err)
{
    (void)o, (void)err;
    he_vec3 normal;
    he_face_normal(m, (he_face){id}, &normal);
    put(normal, out);
    return HE_OK;
}

static he_status face_area(const he_mesh *m, uint32_t id, const options *o, double *out,
                           he_error *err)
{
    (void)o, (void)err;
    *out = he_face_area(m, (he_face){id});
    return HE_OK;
}

static he_status face_centroid(const he_mesh *m, uint32_t id, const options *o, double *out,
                               he_error *err)
{
    (void)o, (void)err;
    put(he_face_centroid(m, (he_face){id}), out);
    return HE_OK;
}

static he_status face_degree(const he_mesh *m, uint32_t id, const options *o, double *out,
                             he_error *err)
{
    (void)o, (void)err;
    *out = he_face_degree(m, (he_face){id});
    return HE_OK;
}

static he_status face_smallest_angle(const he_mesh *m, uint32_t id, const options *o, double *out,
                                     he_error *err)
{
    (void)o, (void)err;
    *out = he_face_smallest_angle(m, (he_face){id});
    return HE_OK;
}

static const measure measures[] = {
    {HE_VERTEX, "normal", 3, WEIGHTS, vertex_normal, vertex_normals},
    {HE_VERTEX, "area", 1, PLAIN, NULL, vertex_areas},
    {HE_VERTEX, "angle_defect", 1, PLAIN, NULL, angle_defects},
    {HE_VERTEX, "mean_curvature", 1, PLAIN, NULL, mean_curvatures},
    {HE_VERTEX, "gaussian_curvature", 1, PLAIN, NULL, gaussian_curvatures},
    {HE_VERTEX, "degree", 1, PLAIN, vertex_degree, NULL},
    {HE_HALFEDGE, "angle", 1, PLAIN, corner_angle, NULL},
    {HE_HALFEDGE, "normal", 3, CREASE, corner_normal, corner_normals},
    {HE_EDGE, "length", 1, PLAIN, edge_length, NULL},
    {HE_EDGE, "dihedral", 1, PLAIN, dihedral, dihedrals},
    {HE_EDGE, "cotangent", 1, PLAIN, NULL, edge_cotangents},
    {HE_FACE, "normal", 3, PLAIN, face_normal, NULL},
    {HE_FACE, "area", 1, PLAIN, face_area, NULL},
    {HE_FACE, "degree", 1, PLAIN, face_degree, NULL},
    {HE_FACE, "smallest_angle", 1, PLAIN, face_smallest_angle, NULL},
    {HE_FACE, "centroid", 3, PLAIN, face_centroid, NULL},
};
enum { MEASURES = sizeof measures / sizeof measures[0] };

/* --- reading a question --- */

typedef struct asked {
    api_target target;
    const measure *measure;
    options options;
    bool as_text; /* true if the values will be written as JSON */
} asked;

static bool read_name(const api_in *name, he_kind kind, const measure **out)
{
    const char *names[MEASURES + 1] = {NULL};
    const measure *rows[MEASURES];
    size_t count = 0;
    int choice;
    for (size_t i = 0; i < MEASURES; i++) {
        if (measures[i].of == kind) {
            names[count] = measures[i].name;
            rows[count++] = &measures[i];
        }
    }
    if (!api_in_choice(name, names, &choice)) {
        return false;
    }
    *out = rows[choice];
    return true;
}

static bool read_options(const api_in *question, asked *q)
{
    static const char *const weights[] = {[HE_WEIGHT_AREA] = "area",
                                          [HE_WEIGHT_ANGLE] = "angle",
                                          [HE_WEIGHT_UNIFORM] = "uniform",
                                          NULL};
    api_in in;
    int choice = HE_WEIGHT_ANGLE;
    if (api_in_find(question, "weights", &in)) {
        if (q->measure->option != WEIGHTS) {
            return api_in_fail(&in, API_UNKNOWN_MEMBER,
                               "\"weights\" is for normals of vertices only");
        }
        if (!api_in_choice(&in, weights, &choice)) {
            return false;
        }
    }
    q->options.weight = (he_weight)choice;
    if (q->measure->option == CREASE) {
        return api_in_need(question, "crease", &in) &&
               api_in_number_within(&in, 0, HE_PI, false, &q->options.crease);
    }
    if (api_in_find(question, "crease", &in)) {
        return api_in_fail(&in, API_UNKNOWN_MEMBER, "\"crease\" is for normals of half-edges only");
    }
    return true;
}

static bool read(api_asker *a, const api_in *question, asked *q)
{
    static const char *const members[] = {"measure", "of", "weights", "crease", NULL};
    api_in name, of;
    *q = (asked){.measure = NULL};
    return api_in_only(question, members) && api_in_need(question, "measure", &name) &&
           api_in_need(question, "of", &of) && api_asker_target(a, &of, &q->target) &&
           read_name(&name, q->target.kind, &q->measure) && read_options(question, q);
}

/* --- the cost of a question --- */

static uint64_t beside(const he_mesh *m, he_halfedge h)
{
    he_face f = he_face_of(m, h);
    return f.i == HE_NONE ? 1 : he_face_degree(m, f);
}

static uint64_t about(const he_mesh *m, he_vertex v, uint64_t most)
{
    he_halfedge first = he_vertex_halfedge(m, v), h = first;
    uint64_t cost = 1;
    if (he_is_none(first.i)) {
        return cost;
    }
    do {
        cost += beside(m, h);
        h = he_swing_ccw(m, h);
    } while (h.i != first.i && cost <= most);
    return cost;
}

/* Returns how many half-edges are visited to measure one element. */
static uint64_t cost_of(const he_mesh *m, const asked *q, uint32_t id, uint64_t most)
{
    switch (q->target.kind) {
    case HE_VERTEX:
        return about(m, (he_vertex){id}, most);
    case HE_HALFEDGE:
        return q->measure->option == CREASE ? about(m, he_origin(m, (he_halfedge){id}), most) : 1;
    case HE_EDGE:
        return beside(m, (he_halfedge){2u * id}) + beside(m, (he_halfedge){2u * id + 1u});
    case HE_FACE:
        return he_face_degree(m, (he_face){id});
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 1;
}

/* Returns the cost of triangulating all faces of the mesh. To triangulate a face may cost the
 * square of its number of corners. */
static uint64_t cost_of_cutting(const he_mesh *m)
{
    uint64_t cost = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            uint64_t degree = he_face_degree(m, (he_face){f});
            cost += degree > 4 ? degree * degree : 0;
        }
    }
    return cost;
}

static bool pay(api_asker *a, const api_in *question, const asked *q, const selection *of)
{
    const size_t count = of->count;
    if (of->ids == NULL) {
        uint64_t pass = api_elements_of(a->mesh);
        pass += q->as_text ? (uint64_t)count * (q->measure->components + 1) : 0;
        if (!api_asker_waits(a, (double)pass / API_MEASURE_PER_SECOND)) {
            return false;
        }
        uint64_t cost = he_mesh_count(a->mesh, HE_HALFEDGE) + (uint64_t)count;
        cost += q->measure->one == NULL ? cost_of_cutting(a->mesh) : 0;
        if (a->on_worker && cost >= api_asker_left(a)) {
            return api_asker_exceed(a, question);
        }
        /* A question about all elements is not refused even if it costs more than is left: one pass
         * over the mesh is always allowed. */
        api_asker_pay(a, cost);
        return true;
    }
    uint64_t cost = 0;
    for (size_t i = 0; i < count && cost <= api_asker_left(a); i++) {
        cost += cost_of(a->mesh, q, of->ids[i], api_asker_left(a));
    }
    if (cost > api_asker_left(a)) {
        return api_asker_exceed(a, question);
    }
    api_asker_pay(a, cost);
    return true;
}

/* --- answering a question --- */

static he_status each(const he_mesh *m, const asked *q, const selection *of, he_progress *progress,
                      double *out, he_error *err)
{
    const measure *what = q->measure;
    he_status status = HE_OK;
    for (size_t i = 0; of->ids != NULL && i < of->count && status == HE_OK; i++) {
        status = what->one(m, of->ids[i], &q->options, out, err);
        out += what->components;
    }
    uint32_t issued = of->ids == NULL ? he_mesh_issued(m, q->target.kind) : 0;
    for (uint32_t id = 0; id < issued && status == HE_OK; id++) {
        status = he_progress_at(progress, id, issued, err);
        if (status == HE_OK && he_mesh_is_live(m, q->target.kind, id)) {
            status = what->one(m, id, &q->options, out, err);
            out += what->components;
        }
    }
    return status;
}

static bool find(api_asker *a, const api_in *question, const asked *q, const selection *of,
                 double *out)
{
    he_error err = {0};
    if (!pay(a, question, q, of)) {
        return false;
    }
    bool all = of->ids == NULL;
    bool whole = q->measure->one == NULL || (all && q->measure->many != NULL);
    options chosen = q->options;
    chosen.progress = &a->x->progress;
    chosen.most = all ? UINT64_MAX : api_asker_left(a);
    he_status status = whole ? q->measure->many(a->mesh, of, &chosen, out, &err)
                             : each(a->mesh, q, of, &a->x->progress, out, &err);
    return status == HE_OK || api_asker_refuse(a, question, &err);
}

static void write_value(api_out *out, const measure *what, const double *value)
{
    if (what->components == 3) {
        api_out_vec3(out, (he_vec3){value[0], value[1], value[2]});
    } else {
        api_out_number(out, *value);
    }
}

/* Finds the values of many elements; `count` of the result is the number of elements at first. */
static bool find_dense(api_asker *a, const api_in *question, const asked *q, api_measured *out)
{
    out->count = q->target.of != NULL ? q->target.count : he_mesh_count(a->mesh, q->target.kind);
    out->values = he_mem_array(NULL, out->count + 1, q->measure->components * sizeof *out->values);
    if (out->values == NULL) {
        return api_in_fail(question, HE_NO_MEMORY,
                           "no memory for the measured values of %zu elements", out->count);
    }
    const selection of = {q->target.of, out->count};
    out->count *= q->measure->components;
    return find(a, question, q, &of, out->values) &&
           api_asker_name(a, question, &q->target, &out->named);
}

void api_measured_clear(api_measured *measured)
{
    he_mem_free(measured->values);
    he_ids_clear(&measured->named.ids);
    *measured = (api_measured){.count = 0};
}

bool api_measure_is_dense(const api_in *question)
{
    api_in in;
    return api_in_is_object(question) && api_in_find(question, "measure", &in) &&
           api_in_find(question, "of", &in) && api_target_is_dense(&in);
}

bool api_measure_dense(api_asker *a, const api_in *question, api_measured *out)
{
    asked q;
    return read(a, question, &q) && (a->reads_only || find_dense(a, question, &q, out));
}

static he_status write_many(api_asker *a, const measure *what, const api_measured *found,
                            he_error *err)
{
    he_status status = HE_OK;
    api_out_object_begin(a->out);
    api_out_key_string(a->out, "measure", what->name);
    api_out_key_u64(a->out, "components", what->components);
    if (found->named.all) {
        api_out_key_ids(a->out, "elements", found->named.ids.ids, found->named.ids.count);
    }
    api_out_key(a->out, "values");
    api_out_array_begin(a->out);
    for (size_t i = 0; i < found->count && status == HE_OK; i += what->components) {
        status = he_progress_at(&a->x->progress, i, found->count, err);
        write_value(a->out, what, found->values + i);
    }
    api_out_array_end(a->out);
    api_out_object_end(a->out);
    return status;
}

static bool ask_many(api_asker *a, const api_in *question, const asked *q)
{
    api_measured found = {.count = 0};
    he_error err = {0};
    bool good = find_dense(a, question, q, &found);
    if (good && write_many(a, q->measure, &found, &err) != HE_OK) {
        good = api_asker_refuse(a, question, &err);
    }
    api_measured_clear(&found);
    return good;
}

bool api_measure_ask(api_asker *a, const api_in *question)
{
    asked q;
    double value[3];
    if (!read(a, question, &q)) {
        return false;
    }
    q.as_text = true;
    if (q.target.dense) {
        return ask_many(a, question, &q);
    }
    if (!find(a, question, &q, &(selection){&q.target.id, 1}, value)) {
        return false;
    }
    api_out_object_begin(a->out);
    api_out_key_u64(a->out, "revision", a->revision);
    api_out_key(a->out, "of");
    api_write_reference(a->out, q.target.kind, q.target.id);
    api_out_key_string(a->out, "measure", q.measure->name);
    api_out_key(a->out, "value");
    write_value(a->out, q.measure, value);
    api_out_object_end(a->out);
    return true;
}
