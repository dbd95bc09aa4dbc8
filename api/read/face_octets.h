/* face_octets.h - the corners of all faces as binary data.
 *
 * The answer consists of 32-bit numbers, little-endian, about the n faces that exist, in the order
 * of their ids:
 *
 *     n + 1      offsets: the corners of face i begin at offsets[i] and end before offsets[i + 1]
 *     ...        the vertices at the corners, counter-clockwise
 *     n          the ids of the faces
 *     1          n, from which a reader knows where the other numbers begin
 *
 * POST .../query answers the relation `vertices` of all faces by the same bytes. */
#ifndef HE_API_READ_FACE_OCTETS_H
#define HE_API_READ_FACE_OCTETS_H

#include "api/request/exchange.h"

/* Answers with the corners of all faces of x->content, which is kept as long as the answer is
 * sent. */
void api_face_octets(api_exchange *x);

#endif
