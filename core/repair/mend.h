/* mend.h - a polygon soup (build.h) while it is repaired; shared by the files of this folder. */
#ifndef HE_REPAIR_MEND_H
#define HE_REPAIR_MEND_H

#include "repair/repair.h"

typedef struct he_mend {
    he_soup *soup;
    he_repaired *out;
    bool has_corner_values; /* there are attributes of corners */
    /* The number that each corner of the soup had in the input; NULL if all corners kept their
     * numbers. */
    uint32_t *corner_from;
    /* one bit for each face: set if the repair `orient` reversed the face; NULL if it reversed
     * none */
    uint64_t *turned;
} he_mend;

static inline void he_mend_name(he_repair_account *account, uint32_t a, uint32_t b)
{
    if (account->named < HE_REPAIR_NAMED) {
        account->pairs[account->named++] = (he_repair_pair){a, b};
    }
}
static inline uint32_t he_mend_input(const uint32_t *from, uint32_t i)
{
    return from == NULL ? i : from[i];
}
/* Returns the list 0, 1, ..., `count` - 1, with room for `room` numbers; NULL if memory is out. */
uint32_t *he_mend_same(size_t count, size_t room);
bool he_mend_has_corner_values(const he_soup *soup);
/* Makes the list m->corner_from, which says from which corner of the input each corner comes, if
 * the soup has attributes of corners. */
HE_NODISCARD he_status he_mend_corners(he_mend *m, he_error *err);
/* Returns true if a corner names a vertex that does not exist. */
bool he_mend_has_bad_index(const he_soup *soup);
/* Sets face_of[c] to the face that has corner c. */
void he_mend_faces(const he_soup *soup, uint32_t *face_of);

/* Each of the following functions performs one repair. All except the first two require valid
 * faces, as he_soup_check_faces defines them. */
HE_NODISCARD he_status he_mend_weld(he_mend *m, double tolerance, he_error *err);
HE_NODISCARD he_status he_mend_drop_degenerate(he_mend *m, he_error *err);
HE_NODISCARD he_status he_mend_drop_duplicates(he_mend *m, he_error *err);
/* Orients the faces. If a component cannot be oriented, it is oriented as well as possible if
 * `force` is true; else the function fails. */
HE_NODISCARD he_status he_mend_orient(he_mend *m, bool force, he_error *err);
HE_NODISCARD he_status he_mend_split(he_mend *m, he_error *err);

/* Decides whether the repair `split` is needed: whether he_build would refuse the soup as it is.
 * Its faces must be oriented already. */
HE_NODISCARD he_status he_mend_needs_split(const he_soup *soup, bool *out, he_error *err);

#endif
