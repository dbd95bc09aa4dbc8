/* store_folder.h - folders for the stores of tests, and records that tests write to a journal. */
#ifndef TESTS_STORE_FOLDER_H
#define TESTS_STORE_FOLDER_H

#include "journal/sqlite/sqlite_journal.h"

#include <pthread.h>

enum { FOLDER_PATH = 256 };

/* Makes a new empty folder; `out` becomes its path. */
void folder_make(char out[FOLDER_PATH]);
/* Removes the folder with all files and folders in it. */
void folder_remove(const char *folder);
/* Copies the files of an open store to another folder: the files that a killed process would
 * leave. */
void folder_copy(const char *from, const char *to);
/* Reads a file of the folder; the caller must free the bytes. Returns NULL if the file does not
 * exist. */
unsigned char *folder_read(const char *folder, const char *name, size_t *size);
void folder_write(const char *folder, const char *name, const unsigned char *bytes, size_t size);

/* A journal, and what it has reported to its listener. */
typedef struct told_journal {
    st_journal journal;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t position;
    unsigned losses;
    st_loss loss; /* the latest loss reported */
} told_journal;

/* Registers as the listener of an open journal: from now on `told` keeps the position up to which
 * records are durable or lost, and the losses, as the journal reports them. */
void told_begin(told_journal *told, const st_journal *journal);
/* Opens the journal of the store in a folder, and calls told_begin(). */
void told_open(told_journal *told, const char *folder);
/* Waits until the journal has reported this position as durable or lost. */
void told_wait(told_journal *told, uint64_t position);
unsigned told_losses(told_journal *told);
void told_end(told_journal *told); /* closes the journal */

/* A mesh as a journal knows it: its id, name and counters. */
typedef struct kept_mesh {
    char id[ST_MESH_ID + 1], name[ST_MESH_NAME + 1];
    uint64_t incarnation, number, revision, metadata;
    const he_mesh *content;
} kept_mesh;

/* kept_content makes a record that creates the mesh or replaces the whole mesh, kept_edit a record
 * of an edit. The caller must add the record's body. */
st_record kept_content(kept_mesh *mesh);
st_record kept_edit(kept_mesh *mesh);
st_record kept_rename(kept_mesh *mesh, const char *name);
st_record kept_remove(kept_mesh *mesh);
/* Appends one record. Its body is `body`, or the encoded mesh if the record has mesh data that was
 * not encoded in advance. Returns the record's position, 0 if the record is refused. */
uint64_t kept_append(const st_journal *journal, st_record record, const kept_mesh *mesh,
                     const void *body, size_t size);
st_status kept_status(void); /* returns the reason of the latest refusal */

#endif
