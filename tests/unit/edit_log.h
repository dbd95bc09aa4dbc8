/* edit_log.h - a mesh with a log of random edits, undos and redos as a server would keep it, and
 * with a copy of the mesh after each log entry. One edit can make several changes, all in one
 * delta: change links, positions and values, add and remove columns, and replace the whole mesh. */
#ifndef TESTS_UNIT_EDIT_LOG_H
#define TESTS_UNIT_EDIT_LOG_H

#include "mesh/delta.h"
#include "tests/model/random.h"

enum { EDIT_LOG_MOST = 400 };

typedef struct edit_log_entry {
    size_t step; /* index in edit_log.steps of the edit that was applied or undone */
    bool undo;
    he_mesh *after;
} edit_log_entry;

typedef struct edit_log {
    he_mesh *mesh;
    he_delta *steps[EDIT_LOG_MOST];
    /* for each edit in `steps`, index of the last entry at which it was applied or undone */
    size_t applied[EDIT_LOG_MOST];
    size_t step_count;
    /* stacks of indices in `steps`: of edits that can be undone, and of edits that can be redone */
    size_t done[EDIT_LOG_MOST], undone[EDIT_LOG_MOST];
    size_t done_count, undone_count;
    edit_log_entry entries[EDIT_LOG_MOST + 1]; /* entries[0] is the initial state of the mesh */
    size_t count;
} edit_log;

/* Makes a log of a mesh, which then belongs to the log. */
edit_log *edit_log_new(he_mesh *mesh);
void edit_log_free(edit_log *log);
/* Adds an entry for the edit steps[step], which has just been applied to the mesh or, if `undo` is
 * true, undone. */
void edit_log_note(edit_log *log, size_t step, bool undo);
/* Undoes the last edit that is applied, and adds an entry for the undo. */
void edit_log_undo(edit_log *log);
/* Makes a mesh with columns of attributes, and a log of `entries` random edits, undos and redos. */
edit_log *edit_log_random(md_random *random, size_t entries);
/* Sets marks[kind], for each kind of elements, to the number of ids that the mesh has issued. */
void edit_log_marks(const he_mesh *mesh, uint32_t marks[HE_KIND_COUNT]);
/* Adds a column of attribute values for elements of a random kind; also random is the rule by which
 * edits set values in the column. The column's name contains `serial`. */
void edit_log_add_column(he_mesh *m, md_random *random, unsigned serial);

#endif
