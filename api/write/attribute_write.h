/* attribute_write.h - what PUT, PATCH and DELETE .../attributes/{domain}/{name} share. Their
 * changes are edits of a mesh. The path .../attributes/vertices/position stands for the positions
 * of the vertices, which are written like an attribute but cannot be deleted. */
#ifndef HE_API_WRITE_ATTRIBUTE_WRITE_H
#define HE_API_WRITE_ATTRIBUTE_WRITE_H

#include "api/request/exchange.h"
#include "edit/whole/attribute.h"

/* The state of a request between the decoding of its body and its answer. */
typedef struct api_writing {
    api_text body; /* the body of a PUT */
    api_document document;
    api_in root, expected;
    bool has_expected, dry_run, octets;
    he_column *column;     /* the new column of a PUT, until the mesh owns it */
    unsigned char *values; /* new values, one row after the other */
    size_t count;
    bool same; /* true if `values` is one value for all elements */
    api_in at; /* cursor at the values, for the JSON pointer of a refusal */
    bool has_at;
    bool effect; /* true if the new values differ from the old ones */
    /* Position of the revision in the answer, where it is filled in after the commit. */
    size_t revision_at;
} api_writing;

/* Makes the state of the request. Returns NULL with the problem filled when memory is out. */
api_writing *api_writing_begin(api_exchange *x);

/* Ends the write that was begun: if `good` is true, commits it and answers; else aborts it. Dry
 * runs, and writes that change nothing, are also aborted and answered. `op` is the name that the
 * history shows. */
void api_writing_publish(api_exchange *x, api_writing *w, const char *op, int status, bool good);

/* Returns the member "expected_revision" of the body; NULL if it has none. */
const api_in *api_writing_expected(const api_writing *w);
/* Returns true if the client may change something now, or asks for a dry run. Otherwise the problem
 * says why not. */
bool api_writing_may(api_exchange *x, const api_writing *w);
/* Begins the write. Returns NULL with the problem filled if it is refused. */
he_mesh *api_writing_mesh(api_exchange *x, api_writing *w);

/* Refuses values with 422, because they are well formed but do not fit this mesh. Returns false. */
bool api_writing_refuse(api_exchange *x, const api_writing *w, const he_error *err);

/* Reads the members "expected_revision" and "dry_run" of a JSON body. */
bool api_writing_read_common(api_writing *w, const api_in *root);
/* Reads the member "values" or "value" of a JSON body; leaves `values` of the state NULL if the
 * body has neither. */
bool api_writing_read_values(api_writing *w, const api_in *root, const he_column *column);
/* Checks `count` values that came as binary data. On failure the problem names the byte, counted
 * from the begin of the body, in which the values begin at byte `offset`. */
bool api_writing_check_octets(api_exchange *x, const he_column *column, const void *values,
                              size_t count, size_t offset);
/* Returns `count` numbers as numbers of the type `to`, aligned for it: the numbers at `values`
 * themselves, or a copy that lives as long as the request. The types are equal, or one is float and
 * the other double; a double that a float cannot hold becomes an infinity. Returns NULL with the
 * problem filled when memory is out. */
const void *api_writing_convert(api_exchange *x, he_type from, const void *values, size_t count,
                                he_type to);

#endif
