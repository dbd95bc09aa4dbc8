/* revision_name.h - names of revisions, which the entries of a revision log keep.
 *
 * A name counts against the undo budget of the log, and goes with the entry when that is dropped.
 * So a revision without an entry has no name: the first revision of a mesh, and dropped ones. */
#ifndef HE_STORE_REVISION_NAME_H
#define HE_STORE_REVISION_NAME_H

#include "store/revision_log.h"

/* Checks that st_log_name can give a name of `length` bytes to a revision.
 * Returns ST_AHEAD if the revision does not exist yet.
 * Returns ST_GONE if the log has no entry of the revision.
 * Returns ST_TOO_LARGE if the budget has no room for the name, even without all entries before that
 * of the revision. */
st_status st_log_can_name(const st_revision_log *log, uint64_t revision, size_t length);
/* Returns the name of a revision, "" if it has none or the log has no entry of the revision. */
const char *st_log_name_of(const st_revision_log *log, uint64_t revision);
/* Copies a name into memory that st_log_name takes. Returns NULL if memory is out. */
char *st_log_name_new(const char *name);
/* Gives a revision, whose entry the log must have, the name `takes`, which was made by
 * st_log_name_new; "" takes the name of the revision away. The caller then calls st_log_settle. */
void st_log_name(st_revision_log *log, uint64_t revision, char *takes);
/* Takes the name of an entry away, whether it has one or not. */
void st_log_unname(st_revision_log *log, st_revision *entry);

#endif
