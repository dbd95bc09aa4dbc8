/* advise.c - finds which repairs a polygon soup needs that cannot become a mesh, by trying repairs
 * on a copy of its faces. */
#include "build/soup_check.h"
#include "repair/mend.h"

#include <string.h>

/* Copies the faces of a polygon soup. The copy uses the array of positions of the original. */
static he_status copy_faces(const he_soup *soup, he_soup *out, he_error *err)
{
    *out = (he_soup){.limits = soup->limits,
                     .positions = soup->positions,
                     .vertex_count = soup->vertex_count,
                     .corner_count = soup->corner_count,
                     .face_count = soup->face_count};
    out->corners = he_mem_array(NULL, soup->corner_count, sizeof *out->corners);
    out->starts = he_mem_array(NULL, soup->face_count, sizeof *out->starts);
    if (out->corners == NULL || out->starts == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to check %zu faces", soup->face_count);
    }
    if (soup->corner_count > 0) {
        memcpy(out->corners, soup->corners, soup->corner_count * sizeof *out->corners);
    }
    if (soup->face_count > 0) {
        memcpy(out->starts, soup->starts, soup->face_count * sizeof *out->starts);
    }
    return HE_OK;
}

/* How many faces run along an edge from its vertex with the lower id to its vertex with the higher
 * id (`up`), and how many run in the opposite direction (`down`). */
typedef struct runs {
    uint32_t up, down;
} runs;

static void count_runs(const he_soup *soup, const uint64_t *gone, const uint32_t *edge_of,
                       runs *edges)
{
    for (size_t f = 0; f < soup->face_count; f++) {
        uint32_t begin = soup->starts[f], end = he_soup_end(soup, f);
        for (uint32_t c = begin; c < end && !he_bits_get(gone, f); c++) {
            uint32_t next = soup->corners[c + 1 < end ? c + 1 : begin];
            edges[edge_of[c]].up += soup->corners[c] < next;
            edges[edge_of[c]].down += soup->corners[c] > next;
        }
    }
}

/* Returns true if face f has an edge that is invalid before the duplicate faces are dropped,
 * because too many faces run along it, and that is valid afterwards. */
static bool mends_edge(const he_soup *soup, size_t f, const uint32_t *edge_of, const runs *before,
                       const runs *after)
{
    bool mends = false;
    for (uint32_t c = soup->starts[f], end = he_soup_end(soup, f); c < end && !mends; c++) {
        uint32_t e = edge_of[c];
        mends = (before[e].up > 1 || before[e].down > 1) && after[e].up + after[e].down <= 2;
    }
    return mends;
}

/* Decides whether dropping each duplicate face makes an invalid edge valid. If two solids touch and
 * each has the wall between them, the wall is a duplicate face, but dropping it leaves the edges
 * invalid: such a soup needs the repair `split` instead. */
static he_status all_mend(const he_soup *soup, const he_repaired *done, bool *out, he_error *err)
{
    size_t edges = 0;
    uint32_t *edge_of = he_mem_array(NULL, soup->corner_count, sizeof *edge_of);
    uint64_t *gone = he_bits_new(soup->face_count), *none = he_bits_new(soup->face_count);
    runs *before = NULL, *after = NULL;
    he_status status = HE_OK;
    if (edge_of != NULL && gone != NULL && none != NULL) {
        status = he_soup_number_edges(soup, edge_of, &edges, err);
        before = he_mem_zero(edges + 1, sizeof *before);
        after = he_mem_zero(edges + 1, sizeof *after);
    }
    if (status == HE_OK && (before == NULL || after == NULL)) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to check %zu faces", soup->face_count);
    }
    if (status == HE_OK) {
        for (size_t f = 0, kept = 0; f < soup->face_count; f++) {
            if (kept < done->faces && done->face_from[kept] == f) {
                kept++;
            } else {
                he_bits_set(gone, f);
            }
        }
        count_runs(soup, none, edge_of, before);
        count_runs(soup, gone, edge_of, after);
        *out = true;
        for (size_t f = 0; f < soup->face_count && *out; f++) {
            *out = !he_bits_get(gone, f) || mends_edge(soup, f, edge_of, before, after);
        }
    }
    he_mem_free(edge_of);
    he_mem_free(gone);
    he_mem_free(none);
    he_mem_free(before);
    he_mem_free(after);
    return status;
}

/* What find_needs learns about duplicate faces. `some`: the soup has duplicate faces. `mend`:
 * dropping each of the duplicate faces makes an invalid edge valid. */
typedef struct duplicates {
    bool some, mend;
} duplicates;

/* Finds which of the repairs `split` and `orient` a soup of valid faces needs. If `dropped` is not
 * NULL, duplicate faces are dropped before these repairs are tried. If there are no duplicate
 * faces, dropped->some becomes false and no repair is tried. */
static he_status find_needs(const he_soup *soup, duplicates *dropped, unsigned *out, he_error *err)
{
    he_soup copy;
    he_repaired *done = he_mem_zero(1, sizeof *done);
    he_mend m = {.soup = &copy, .out = done};
    bool splits = false;
    he_status status = copy_faces(soup, &copy, err);
    if (status == HE_OK && done == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to search for repairs");
    }
    bool goes_on = true;
    if (status == HE_OK && dropped != NULL) {
        status = he_mend_drop_duplicates(&m, err);
        goes_on = dropped->some = done->accounts[HE_REPAIR_DROP_DUPLICATES].count > 0;
    }
    if (status == HE_OK && dropped != NULL && goes_on) {
        status = all_mend(soup, done, &dropped->mend, err);
    }
    if (status == HE_OK && goes_on) {
        status = he_mend_orient(&m, true, err);
    }
    if (status == HE_OK && goes_on) {
        status = he_mend_needs_split(&copy, &splits, err);
    }
    if (status == HE_OK && goes_on) {
        const he_repair_account *orient = &done->accounts[HE_REPAIR_ORIENT];
        *out = (splits ? he_repair_bit(HE_REPAIR_SPLIT) : 0) |
               (orient->count + orient->left > 0 ? he_repair_bit(HE_REPAIR_ORIENT) : 0);
    }
    if (done != NULL) {
        he_repaired_clear(done);
        he_mem_free(done);
    }
    he_mem_free(m.turned);
    he_mem_free(copy.corners);
    he_mem_free(copy.starts);
    return status;
}

/* Advises to drop duplicate faces if the repair `split` or `orient` then becomes unnecessary, or if
 * each duplicate face makes an edge invalid. */
static he_status advise_proper(const he_soup *soup, unsigned *out, he_error *err)
{
    unsigned as_is, less = 0;
    duplicates dropped = {false, false};
    he_status status = find_needs(soup, NULL, &as_is, err);
    if (status == HE_OK && as_is != 0) {
        status = find_needs(soup, &dropped, &less, err);
    }
    if (status == HE_OK) {
        bool spares = (less & he_repair_bit(HE_REPAIR_SPLIT)) == 0 && less != as_is;
        *out = dropped.some && (spares || dropped.mend)
                   ? less | he_repair_bit(HE_REPAIR_DROP_DUPLICATES)
                   : as_is;
    }
    return status;
}

he_status he_repair_advise(he_soup *soup, unsigned asked, unsigned *out, he_error *err)
{
    unsigned needs = 0;
    he_repaired *done = NULL;
    if (he_mend_has_bad_index(soup)) {
        *out = 0;
        return HE_OK;
    }
    done = he_mem_zero(1, sizeof *done);
    if (done == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to search for repairs");
    }
    he_mend m = {.soup = soup, .out = done};
    he_status status = he_mend_drop_degenerate(&m, err);
    const he_repair_account *dropped = &done->accounts[HE_REPAIR_DROP_DEGENERATE];
    bool drops = dropped->count + dropped->parts > 0;
    if (status == HE_OK) {
        status = advise_proper(soup, &needs, err);
    }
    if (status == HE_OK) {
        *out = asked | needs | (drops ? he_repair_bit(HE_REPAIR_DROP_DEGENERATE) : 0);
    }
    he_repaired_clear(done);
    he_mem_free(done);
    return status;
}
