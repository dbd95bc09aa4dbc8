#include "build/corner.h"

static bool have_degree(const he_soup *soup, size_t degree)
{
    bool all = degree * soup->face_count == soup->corner_count;
    for (size_t f = 0; f < soup->face_count && all; f++) {
        all = soup->starts[f] == f * degree;
    }
    return all;
}

he_status he_corners_init(const he_soup *soup, he_corners *out, he_error *err)
{
    uint32_t degree = have_degree(soup, 3) ? 3 : have_degree(soup, 4) ? 4 : 0;
    uint32_t *face_of = NULL;
    if (degree == 0) {
        face_of = he_mem_array(NULL, soup->corner_count, sizeof *face_of);
        if (face_of == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu corners",
                                 soup->corner_count);
        }
        for (size_t f = 0; f < soup->face_count; f++) {
            for (uint32_t c = soup->starts[f], end = he_soup_end(soup, f); c < end; c++) {
                face_of[c] = (uint32_t)f;
            }
        }
    }
    *out = (he_corners){soup, degree, face_of};
    return HE_OK;
}

void he_corners_clear(he_corners *corners)
{
    he_mem_free(corners->face_of);
    *corners = (he_corners){0};
}
