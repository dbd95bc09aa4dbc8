/* sqlite_schema.h - the tables of hedge.db, version 4, and the checksums of their rows.
 *
 * Every row has a column `sum`: CRC-32C over its table's name and its values, keys included. Rows
 * of the tables record and part have no such column, because their bytes contain checksums. Without
 * checksums a flipped bit in a number would silently load or delete the wrong data. */
#ifndef HE_JOURNAL_SQLITE_SCHEMA_H
#define HE_JOURNAL_SQLITE_SCHEMA_H

#include "journal/record.h"
#include "journal/sqlite/sqlite_db.h"

enum {
    /* the present version of the tables: version 1 had no jobs, version 2 no holders of meshes,
     * version 3 no indexes for sorted lists of meshes */
    ST_SCHEMA_VERSION = 4,
    ST_SCHEMA_APPLICATION = 0x68656467, /* "hedg" */
    ST_RELEASE = 32,                    /* bytes of a release's name */
    ST_KEY_TEXT = 255,                  /* most bytes of an Idempotency-Key */
    ST_KEY_HOLDER = 64 /* most bytes of the name of the client that sent an Idempotency-Key */
};

/* The identity of the store, which is drawn when the store is made and never changes. */
typedef struct st_identity {
    uint64_t store, secret[2];
    char made_by[ST_RELEASE];
} st_identity;

/* The row that each commit updates: the number of the last commit, the position of the last record,
 * and the number of meshes. */
typedef struct st_progress {
    uint64_t commits, position, meshes;
} st_progress;

/* The row of a mesh. `card` is the mesh's short description (name, counts and so on); `origin` is
 * the random number with which the chain of hashes of its records began (record_bytes.h), `chain`
 * is the hash that the next record of the mesh must have, and `base` is the number of the record
 * from which the mesh is loaded. */
typedef struct st_mesh_row {
    int64_t key;
    st_card card;
    uint64_t origin, chain, base;
} st_mesh_row;

/* The row of a snapshot: the whole content of a mesh after record `number`, stored in parts. If the
 * snapshot belongs to no mesh yet, `process` is the process that is writing it. `facts` is record
 * `number`, encoded without a body (a frame, record_bytes.h), and `chain` is the hash that the
 * record after `number` must have. */
typedef struct st_snapshot_row {
    int64_t key, mesh;
    uint64_t number, revision, parts, process, chain;
    const unsigned char *facts;
    size_t facts_size;
} st_snapshot_row;

/* The kinds of rows in the table `purge`, which lists what is to be deleted. */
typedef enum st_purge_kind {
    ST_PURGE_MESH = 1,    /* the records of a mesh that was removed */
    ST_PURGE_RECORDS = 2, /* the records of a mesh whose number is below `before` */
    ST_PURGE_PARTS = 3    /* the parts of a snapshot */
} st_purge_kind;

typedef struct st_purge_row {
    st_purge_kind kind;
    int64_t key;
    uint64_t before;
} st_purge_row;

/* The row of a stored Idempotency-Key; `mesh` is 0 if the key belongs to the store. */
typedef struct st_kept_row {
    int64_t mesh;
    const char *holder, *text, *id;
    uint64_t digest[2];
    double time;
    uint64_t incarnation, revision, metadata, position;
    bool made; /* true if the request with the key created the mesh, so that its answer was 201 */
} st_kept_row;

/* Memory for the texts of the row of a stored Idempotency-Key. */
typedef struct st_kept_texts {
    char id[ST_MESH_ID + 1], text[ST_KEY_TEXT + 1], holder[ST_KEY_HOLDER + 1];
} st_kept_texts;

/* --- checksums --- */

uint32_t st_progress_sum(const st_progress *progress);
uint32_t st_mesh_row_sum(const st_mesh_row *row);
uint32_t st_snapshot_row_sum(const st_snapshot_row *row);
uint32_t st_purge_row_sum(const st_purge_row *row);
uint32_t st_kept_row_sum(const st_kept_row *row);
uint32_t st_job_sum(const st_job *job);

/* The row of a part of a content begins with ST_PART_HEAD bytes: 4 of the checksum, 1 of the
 * coding. The checksum covers the part and also the numbers of the snapshot and of the part. */
enum { ST_PART_HEAD = 5 };
uint32_t st_part_sum(int64_t snapshot, uint64_t part, const unsigned char *bytes, size_t size);

/* --- reading rows: lists of columns, in the order that the functions below expect --- */

#define ST_MESH_COLUMNS                                                                          \
    "key, id, name, incarnation, origin, metadata, revision, record, chain, created, modified, " \
    "vertices, edges, faces, boundary, bytes, base, damage, sum, holder"
#define ST_SNAPSHOT_COLUMNS "key, mesh, number, revision, parts, process, chain, facts, sum"
#define ST_PURGE_COLUMNS    "kind, key, before, sum"
#define ST_KEPT_COLUMNS \
    "mesh, text, digest, time, id, incarnation, revision, metadata, position, made, sum, holder"
enum { ST_KEPT_COUNT = 12 }; /* number of the columns above */
#define ST_JOB_COLUMNS                                                                          \
    "id, number, state, operation, phase, mesh, location, holder, progress, created, started, " \
    "finished, status, shown, type, disposition, tag, warnings, body, sum"

/* Reads the row of a mesh. Returns false if the checksum is wrong; *out is filled in even then. */
bool st_mesh_row_read(sqlite3_stmt *statement, st_mesh_row *out);
/* Reads the row of a snapshot; `facts` is borrowed from the statement. Returns false if the
 * checksum is wrong. */
bool st_snapshot_row_read(sqlite3_stmt *statement, st_snapshot_row *out);
bool st_purge_row_read(sqlite3_stmt *statement, st_purge_row *out);
/* Reads the row of a job; its texts and body are borrowed from the statement. Returns false if the
 * checksum is wrong. */
bool st_job_read(sqlite3_stmt *statement, st_job *out);

/* --- the whole database --- */

/* Makes the tables, in one transaction. */
st_sql st_schema_make(st_db *db, const st_identity *identity);
/* Upgrades tables of an older version to ST_SCHEMA_VERSION, in one transaction. */
st_sql st_schema_raise(st_db *db);
/* Compares the SQL texts by which the tables were made with the texts that their version should
 * have.
 * Returns ST_SQL_DAMAGED if they differ. */
st_sql st_schema_check(st_db *db);
/* Reads the identity of the store.
 * Returns ST_SQL_DAMAGED if rows are missing or their checksums are wrong. */
st_sql st_identity_read(st_db *db, st_identity *out);
st_sql st_progress_read(st_db *db, st_progress *out);

#endif
