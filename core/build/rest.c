#include "build/rest.h"

#include "build/soup_check.h"
#include "build/swing.h"

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to check %zu faces", soup->face_count);
}

static bool is_proper(const he_soup *soup, size_t f, uint32_t *stamp)
{
    uint32_t begin = soup->starts[f], count = he_soup_end(soup, f) - begin, i = 0;
    while (i < count && soup->corners[begin + i] < soup->vertex_count) {
        i++;
    }
    return count >= 3 && i == count &&
           he_soup_find_repeat(soup->corners + begin, count, stamp, (uint32_t)f + 1) == count;
}

/* Copies the valid faces of a soup to `out` and lists their numbers in the soup in `from`. */
static he_status copy_proper(const he_soup *soup, he_soup *out, he_ids *from, he_error *err)
{
    uint32_t *stamp = he_mem_zero(soup->vertex_count + 1, sizeof *stamp);
    he_status status = stamp == NULL ? no_memory(soup, err) : HE_OK;
    for (uint32_t f = 0; f < soup->face_count && status == HE_OK; f++) {
        status = he_progress_at(soup->limits.progress, f, soup->face_count, err);
        if (status != HE_OK || !is_proper(soup, f, stamp)) {
            continue;
        }
        uint32_t begin = soup->starts[f];
        status = he_soup_add_face(out, soup->corners + begin, he_soup_end(soup, f) - begin, err);
        if (status == HE_OK) {
            status = he_ids_add(from, f, err);
        }
    }
    he_mem_free(stamp);
    return status;
}

static he_status check(const he_soup *proper, he_report *report, uint64_t *total, he_error *err)
{
    he_corners corners = {0};
    he_swings swings = {0};
    he_status status = he_corners_init(proper, &corners, err);
    if (status == HE_OK) {
        status = he_soup_swing(&corners, &swings, report, total, err);
    }
    he_corners_clear(&corners);
    he_swings_clear(&swings);
    return status;
}

/* Appends the defects in `rest` to `report`. They were found in a soup of only the valid faces, so
 * their face numbers are replaced by those in the original soup. */
static void append(const he_report *rest, const he_ids *from, he_report *report, uint64_t *total)
{
    uint64_t told = 0;
    for (; told < rest->total && told < HE_REPORT_DEFECTS; told++) {
        he_defect defect = rest->defects[told];
        if (defect.kind == HE_FACE) {
            defect.id = from->ids[defect.id];
        }
        he_report_add(report, total, defect);
    }
    *total += rest->total - told;
    if (report != NULL) {
        report->total = *total;
    }
}

he_status he_soup_check_rest(const he_soup *soup, he_report *report, uint64_t *total, he_error *err)
{
    he_ids from = {0};
    he_soup proper = {.limits = {.progress = soup->limits.progress},
                      .positions = soup->positions,
                      .vertex_count = soup->vertex_count};
    uint64_t more = 0;
    he_report *rest = he_mem_alloc(sizeof *rest);
    if (rest == NULL) {
        return no_memory(soup, err);
    }
    rest->total = 0;
    he_status status = copy_proper(soup, &proper, &from, err);
    if (status == HE_OK && from.count > 0 && from.count < soup->face_count) {
        status = check(&proper, rest, &more, err);
    }
    if (status == HE_OK) {
        append(rest, &from, report, total);
    }
    he_mem_free(rest);
    he_mem_free(proper.corners);
    he_mem_free(proper.starts);
    he_ids_clear(&from);
    return status;
}
