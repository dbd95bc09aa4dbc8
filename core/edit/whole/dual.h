/* dual.h - exchanges the roles of faces and vertices. */
#ifndef HE_EDIT_WHOLE_DUAL_H
#define HE_EDIT_WHOLE_DUAL_H

#include "mesh/mesh.h"

/* dual: in a closed mesh, V becomes F, E stays E, F becomes V. Every face becomes a */
HE_NODISCARD he_status he_dual(he_mesh *m, he_error *err);

#endif
