/* edit_log.h - the log of a mesh as a server would keep it: random edits, undo and redo, with a
 * copy of the mesh after each entry. An edit can change links, positions and values, add and remove
 * columns, and replace the content, several of these in one delta. */
#ifndef TESTS_UNIT_EDIT_LOG_H
#define TESTS_UNIT_EDIT_LOG_H

#include "mesh/delta.h"
#include "tests/model/random.h"

enum { EDIT_LOG_MOST = 400 };

typedef struct edit_log_entry {
    size_t step; /* index of the step that the entry applied */
    bool undo;
    he_mesh *after;
} edit_log_entry;

typedef struct edit_log {
    he_mesh *mesh;
    he_delta *steps[EDIT_LOG_MOST];
    size_t applied[EDIT_LOG_MOST]; /* for each step, the last entry that applied or undid it */
    size_t step_count;
    size_t done[EDIT_LOG_MOST], undone[EDIT_LOG_MOST]; /* stacks of undo and redo */
    size_t done_count, undone_count;
    edit_log_entry entries[EDIT_LOG_MOST + 1]; /* entry 0 is the initial state */
    size_t count;
} edit_log;

/* Makes a log of a mesh, which then belongs to the log. */
edit_log *edit_log_new(he_mesh *mesh);
void edit_log_free(edit_log *log);
/* Adds an entry for a step that has just been applied to the mesh or undone. */
void edit_log_note(edit_log *log, size_t step, bool undo);
/* Undoes the last step that is not undone, and adds an entry for this. */
void edit_log_undo(edit_log *log);
/* Makes a log with that many random entries, of a mesh with columns of attributes. */
edit_log *edit_log_random(md_random *random, size_t entries);
/* Finds, for each kind, how many ids the mesh has issued. */
void edit_log_marks(const he_mesh *mesh, uint32_t marks[HE_KIND_COUNT]);
/* Adds a column for elements of a random kind and with a random rule; its name contains
 * `serial`. */
void edit_log_add_column(he_mesh *m, md_random *random, unsigned serial);

#endif
