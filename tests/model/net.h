/* net.h - compares the sets that an edit reports (created, deleted, modified) with the differences
 * between the two states of the mesh. */
#ifndef TESTS_MODEL_NET_H
#define TESTS_MODEL_NET_H

#include "mesh/delta.h"

enum { MD_NET_TEXT = 160 };

/* Returns whether the sets describe how the mesh `is` differs from the mesh `was`; if not, `text`
 * says why. */
bool md_net_matches(const he_mesh *was, const he_mesh *is, const he_changes *changes,
                    char text[MD_NET_TEXT]);

#endif
