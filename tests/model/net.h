/* net.h - compares the sets that an edit reports with the differences of the two states of the
 * mesh. */
#ifndef TESTS_MODEL_NET_H
#define TESTS_MODEL_NET_H

#include "mesh/delta.h"

enum { MD_NET_TEXT = 160 };

/* Do created, deleted and modified describe how `is` differs from `was`? */
bool md_net_matches(const he_mesh *was, const he_mesh *is, const he_changes *changes,
                    char text[MD_NET_TEXT]);

#endif
