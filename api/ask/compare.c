/* compare.c - POST .../compare: how far the surface of a mesh is from that of another mesh, or of
 * an earlier revision of the same mesh.
 *
 * Both are snapshots, so neither mesh is locked while they are compared. */
#include "api/request/handlers.h"

#include "api/ask/records.h"
#include "api/request/mesh_access.h"
#include "api/ask/other_mesh.h"
#include "compare/compare.h"

#include <float.h>

enum { BINS = 32 /* default */ };

/* The progress (0 to 1) of a comparison when the trees of boxes of both meshes have been made. */
static const double TREES[2] = {0.15, 0.3};

/* What the request asks for, and what was found. */
typedef struct comparison {
    api_other_mesh with;
    uint64_t with_elements; /* of the revision that is compared with */
    double bound;           /* 0: the default */
    uint32_t bins;
    uint64_t revision;
    he_bvh *tree[2];
    he_comparison found;
} comparison;

static void free_comparison(void *state)
{
    comparison *c = state;
    api_other_mesh_clear(&c->with);
    he_bvh_free(c->tree[0]);
    he_bvh_free(c->tree[1]);
    he_mem_free(c);
}

/* --- reading the request --- */

static const char *const members[] = {"with", "bound", "bins", NULL};

/* Reads the id of another mesh, or the number of a revision of the mesh in the path. */
static bool read_with(api_exchange *x, comparison *c)
{
    api_in with;
    const char *id = x->mesh_id;
    uint64_t revision = 0;
    if (!api_in_need(&x->root, "with", &with)) {
        return false;
    }
    if (api_in_is_number(&with) ? !api_in_u64(&with, 1, (uint64_t)1 << 53, &revision)
                                : !api_in_string(&with, ST_MESH_ID, &id)) {
        return false;
    }
    return api_other_mesh_find(x, &with, id, revision, &c->with);
}

/* Counts the elements of the other mesh while no mesh is locked: later the mesh in the path is, and
 * the locks of two meshes are never held together. */
static void count_other(comparison *c)
{
    st_mesh_info info;
    c->with_elements = c->with.revision == 0 ? st_read_card(c->with.mesh, &info)
                                             : st_elements_at(c->with.mesh, c->with.revision);
}

static bool read_request(api_exchange *x, comparison *c)
{
    api_in in;
    uint64_t bins = BINS;
    if (!api_in_only(&x->root, members) ||
        (api_in_find(&x->root, "bound", &in) &&
         !api_in_number_within(&in, 0, DBL_MAX, true, &c->bound)) ||
        (api_in_find(&x->root, "bins", &in) && !api_in_u64(&in, 0, HE_COMPARE_BINS, &bins))) {
        return false;
    }
    c->bins = (uint32_t)bins;
    return read_with(x, c);
}

static void load_other(api_exchange *x)
{
    comparison *c = x->state;
    if (api_other_mesh_load(x, &c->with)) {
        count_other(c);
        api_read(x);
    }
}

bool api_compare_decode(api_exchange *x)
{
    comparison *c = he_mem_zero(1, sizeof *c);
    if (c == NULL) {
        return api_fail_memory(x);
    }
    x->state = c;
    x->free_state = free_comparison;
    if (!read_request(x, c)) {
        return false;
    }
    if (c->with.mesh == NULL) {
        x->deferred = load_other;
        return false;
    }
    count_other(c);
    return true;
}

/* The work depends on the bound, too, and is too much for a worker thread even if the meshes are
 * small. */
bool api_compare_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    const comparison *c = x->state;
    const uint64_t elements = api_elements_of(mesh) + c->with_elements;
    out->elements = API_COSTLY_ELEMENTS + elements;
    out->seconds = (double)elements / API_COMPARE_PER_SECOND;
    return true;
}

/* --- writing the answer --- */

static const api_field place_fields[] = {
    API_FIELD("face", "id", he_far_place, face, .required = true,
              .doc = "The face on which `point` is."),
    API_FIELD("point", "point", he_far_place, point, .required = true),
    API_FIELD("near_face", "id", he_far_place, near_face, .required = true,
              .doc = "The face of the other surface on which `near_point` is."),
    API_FIELD("near_point", "point", he_far_place, near_point, .required = true,
              .doc = "The nearest point of the other surface."),
};
const api_record api_far_place_record = API_RECORD("far_place", place_fields);

/* The distances in one direction, with the number of bins. Without bins there are no means. */
typedef struct shown_side {
    he_one_sided found;
    uint32_t bins;
    bool has_means;
} shown_side;

static void write_histogram(api_out *out, const void *value)
{
    const shown_side *side = value;
    api_out_array_begin(out);
    for (uint32_t i = 0; i < side->bins; i++) {
        api_out_number(out, side->found.share[i]);
    }
    api_out_array_end(out);
}

static const api_field side_fields[] = {
    API_FIELD("lower", "number", shown_side, found.lower, .required = true,
              .doc = "The largest distance is at least this: it is the distance at `place`."),
    API_FIELD("upper", "number", shown_side, found.upper, .required = true,
              .doc = "No point of the surface is farther from the other one."),
    API_FIELD_RECORD("place", "#far_place", shown_side, found.place, &api_far_place_record,
                     .required = true),
    API_FIELD("mean", "number", shown_side, found.mean, .known = API_KNOWN(shown_side, has_means),
              .doc = "The mean of the distances at samples, weighted by area. Left out if `bins` "
                     "is 0."),
    API_FIELD("rms", "number", shown_side, found.rms, .known = API_KNOWN(shown_side, has_means),
              .doc = "The root mean square of the distances at samples, weighted by area. Left out "
                     "if `bins` is 0."),
    API_FIELD("equal_triangles", "count", shown_side, found.equal_faces, .required = true,
              .doc = "How many triangles of the surface are triangles of the other one, too."),
    API_FIELD_MADE("histogram", "*number", write_histogram, .required = true,
                   .doc = "The share of the area with distances in each bin."),
};
const api_record api_one_sided_record = API_RECORD("one_sided", side_fields);

/* The members of the answer. */
typedef struct shown_comparison {
    uint64_t revision;
    const char *with;
    uint64_t with_revision;
    double bound, lower, upper, bin_width;
    bool complete;
    shown_side forward, backward;
} shown_comparison;

static const api_field comparison_fields[] = {
    API_FIELD("revision", "count", shown_comparison, revision, .required = true),
    API_FIELD("with", "text", shown_comparison, with, .required = true,
              .doc = "The id of the mesh that was compared with."),
    API_FIELD("with_revision", "count", shown_comparison, with_revision, .required = true),
    API_FIELD("bound", "number", shown_comparison, bound, .required = true),
    API_FIELD("lower", "number", shown_comparison, lower, .required = true,
              .doc = "The Hausdorff distance, which is the larger of the two one-sided distances, "
                     "is at least this."),
    API_FIELD("upper", "number", shown_comparison, upper, .required = true,
              .doc = "The Hausdorff distance is at most this."),
    API_FIELD_RECORD("forward", "#one_sided", shown_comparison, forward, &api_one_sided_record,
                     .required = true,
                     .doc = "The distances of the points of this mesh from the other one."),
    API_FIELD_RECORD("backward", "#one_sided", shown_comparison, backward, &api_one_sided_record,
                     .required = true,
                     .doc = "The distances of the points of the other mesh from this one."),
    API_FIELD("bin_width", "number", shown_comparison, bin_width, .required = true,
              .doc = "The width of the bins of both histograms, whose first bins begin at 0. It "
                     "is 0 if `bins` is 0."),
    API_FIELD("complete", "flag", shown_comparison, complete, .required = true,
              .doc = "False if the bounds are farther apart than `bound`, because too many parts "
                     "of triangles would have to be looked at, or because of rounding."),
};
const api_record api_comparison_record = API_RECORD("comparison", comparison_fields);

static void answer(api_exchange *x, const comparison *c)
{
    shown_comparison *shown = he_mem_zero(1, sizeof *shown);
    if (shown == NULL) {
        api_fail_memory(x);
        return;
    }
    *shown = (shown_comparison){.revision = c->revision,
                                .with = c->with.id,
                                .with_revision = c->with.info.revision,
                                .bound = c->bound,
                                .lower = c->found.lower,
                                .upper = c->found.upper,
                                .bin_width = c->found.bin_width,
                                .complete = c->found.complete,
                                .forward = {c->found.side[0], c->bins, c->bins > 0},
                                .backward = {c->found.side[1], c->bins, c->bins > 0}};
    api_record_write(&x->out, &api_comparison_record, shown);
    he_mem_free(shown);
    api_answer_json(x, 200);
}

/* --- the handler --- */

static he_status compare(api_exchange *x, comparison *c, he_error *err)
{
    const he_mesh *const meshes[2] = {x->content, c->with.content};
    he_status status = HE_OK;
    for (int i = 0; i < 2 && status == HE_OK; i++) {
        he_progress_span(&x->progress, TREES[i]);
        status = he_bvh_new(meshes[i], &x->progress, &c->tree[i], err);
    }
    if (status != HE_OK) {
        return status;
    }
    const he_compared surfaces[2] = {{meshes[0], c->tree[0]}, {meshes[1], c->tree[1]}};
    c->bound = c->bound > 0 ? c->bound : he_compare_default_bound(surfaces);
    const he_compare_options options = {
        .bound = c->bound, .bins = c->bins, .most_pieces = API_MAX_PIECES};
    he_progress_span(&x->progress, 1);
    return he_compare(surfaces, &options, &x->progress, &c->found, err);
}

void api_compare_post(api_exchange *x)
{
    comparison *c = x->state;
    he_error err = {0};
    c->revision = x->info.revision;
    if (!api_other_mesh_take(x, &c->with)) {
        return;
    }
    if (compare(x, c, &err) == HE_OK) {
        answer(x, c);
    } else {
        api_fail_core(x, &err);
    }
    api_other_mesh_release(&c->with);
}
