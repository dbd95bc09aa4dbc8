/* net_write.h - writes a net back into the mesh of which it was made. */
#ifndef HE_REMESH_NET_WRITE_H
#define HE_REMESH_NET_WRITE_H

#include "remesh/ground.h"
#include "remesh/net.h"

/* Makes a copy of the mesh in which the triangles of the ground, which are those of which the net
 * was made, are replaced by those of the net. Gives final ids to the new elements of the net.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_net_write(he_net *n, const he_ground *g, const he_mesh *m, he_mesh **out,
                                    he_error *err);

/* Sets the attributes of the elements of `made` that the net has made or changed (remesh.h). */
HE_NODISCARD he_status he_net_carry(const he_net *n, const he_ground *g, const he_mesh *m,
                                    he_mesh *made, he_error *err);

#endif
