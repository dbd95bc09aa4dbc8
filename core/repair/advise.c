/* Which repairs a refused soup needs. Each is tried on a copy of its faces. */
#include "repair/mend.h"

#include <string.h>

/* Copy what the faces are; positions are lent. */
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
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look at %zu faces", soup->face_count);
    }
    if (soup->corner_count > 0) {
        memcpy(out->corners, soup->corners, soup->corner_count * sizeof *out->corners);
    }
    if (soup->face_count > 0) {
        memcpy(out->starts, soup->starts, soup->face_count * sizeof *out->starts);
    }
    return HE_OK;
}

/* What proper faces need. With `dropped` the duplicates are dropped first; where there are none
 * that is false, and nothing else is found. */
static he_status find_needs(const he_soup *soup, bool *dropped, unsigned *out, he_error *err)
{
    he_soup copy;
    he_repaired *done = he_mem_zero(1, sizeof *done);
    he_mend m = {.soup = &copy, .out = done};
    bool splits = false;
    he_status status = copy_faces(soup, &copy, err);
    if (status == HE_OK && done == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to look for repairs");
    }
    bool goes_on = true;
    if (status == HE_OK && dropped != NULL) {
        status = he_mend_drop_duplicates(&m, err);
        goes_on = *dropped = done->accounts[HE_REPAIR_DROP_DUPLICATES].count > 0;
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

/* Dropping duplicates is the answer where it spares a split, or faces the turning. */
static he_status advise_proper(const he_soup *soup, unsigned *out, he_error *err)
{
    unsigned as_is, less = 0;
    bool dropped = false;
    he_status status = find_needs(soup, NULL, &as_is, err);
    if (status == HE_OK && as_is != 0) {
        status = find_needs(soup, &dropped, &less, err);
    }
    if (status == HE_OK) {
        bool spares = dropped && (less & he_repair_bit(HE_REPAIR_SPLIT)) == 0 && less != as_is;
        *out = spares ? less | he_repair_bit(HE_REPAIR_DROP_DUPLICATES) : as_is;
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
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for repairs");
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
