#include "format/ply/ply_groups.h"

const he_ply_group he_ply_groups[HE_PLY_GROUPS] = {
    {"normal", 3, 3, false, true, {"nx", "ny", "nz"}},
    {"color", 3, 4, true, true, {"red", "green", "blue", "alpha"}},
    {"color", 3, 4, true, false, {"r", "g", "b", "a"}},
    {"uv", 2, 2, false, true, {"s", "t"}},
    {"uv", 2, 2, false, false, {"u", "v"}},
    {"uv", 2, 2, false, false, {"texture_u", "texture_v"}},
    {"uv", 2, 2, false, false, {"texture_s", "texture_t"}},
};

double he_ply_full_color(he_ply_type type)
{
    if (type == HE_PLY_FLOAT || type == HE_PLY_DOUBLE) {
        return 1;
    }
    return type == HE_PLY_UINT16 ? UINT16_MAX : UINT8_MAX;
}
