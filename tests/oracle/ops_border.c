#include "oracle/oracle.h"

uint64_t or_edge_delete(or_mesh *o, const uint32_t *e, uint32_t count, bool keep_isolated)
{
    uint32_t faces[2 * OR_LIST];
    uint32_t n = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        bool beside = false;
        for (uint32_t i = 0; i < count && o->face[f].alive; i++) {
            uint32_t a = o->edge[e[i]].a;
            uint32_t b = o->edge[e[i]].b;
            beside = beside || o->left[a][b] == f || o->left[b][a] == f;
        }
        if (beside) {
            faces[n++] = f;
        }
    }
    return or_face_delete(o, faces, n, keep_isolated);
}
