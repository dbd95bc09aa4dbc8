/* edit_log.h - the log of a mesh as a server would keep it: random edits, undo and redo, with a
 * copy of the mesh after each entry. Edits change links, positions and values, add and remove
 * columns, and replace the content, several of these in one delta. */
#ifndef TESTS_UNIT_EDIT_LOG_H
#define TESTS_UNIT_EDIT_LOG_H

#include "mesh/delta.h"
#include "tests/model/random.h"

enum { EDIT_LOG_MOST = 400 };

typedef struct edit_log_entry {
    size_t step; /* an index of steps */
    bool undo;
    he_mesh *after;
} edit_log_entry;

typedef struct edit_log {
    he_mesh *mesh;
    he_delta *steps[EDIT_LOG_MOST];
    size_t applied[EDIT_LOG_MOST]; /* the entry that crossed the step last */
    size_t step_count;
    size_t done[EDIT_LOG_MOST], undone[EDIT_LOG_MOST]; /* stacks of undo and redo */
    size_t done_count, undone_count;
    edit_log_entry entries[EDIT_LOG_MOST + 1]; /* entry 0 is the initial state */
    size_t count;
} edit_log;

/* Takes the mesh. */
edit_log *edit_log_new(he_mesh *mesh);
void edit_log_free(edit_log *log);
/* Adds an entry: the step was applied to the mesh. */
void edit_log_note(edit_log *log, size_t step, bool undo);
/* Undoes the step on top of the stack, and adds its entry. */
void edit_log_undo(edit_log *log);
/* Makes a log with that many entries, of a mesh with columns. */
edit_log *edit_log_random(md_random *random, size_t entries);
/* Finds the numbers of ids that the mesh has issued, by kind. */
void edit_log_marks(const he_mesh *mesh, uint32_t marks[HE_KIND_COUNT]);
/* Adds a column of a random domain and rule, with `serial` in its name. */
void edit_log_add_column(he_mesh *m, md_random *random, unsigned serial);

#endif
