/* net.h - the sets an edit reports, against what two states of a mesh show when compared element
 * by element. */
#ifndef TESTS_MODEL_NET_H
#define TESTS_MODEL_NET_H

#include "mesh/delta.h"

enum { MD_NET_TEXT = 160 };

/* Do created, deleted and modified say how `is` came from `was`? */
bool md_net_matches(const he_mesh *was, const he_mesh *is, const he_changes *changes,
                    char text[MD_NET_TEXT]);

#endif
