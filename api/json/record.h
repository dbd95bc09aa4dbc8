/* record.h - writes plain structs as JSON objects, as tables describe them.
 *
 * A row describes one member of the object: its name, its type in the OpenAPI document, and where
 * its value lies in a struct. Schemas (api/describe/schemas.c) and answers are both made from the
 * rows, so that they cannot disagree:
 *
 *     static const api_field fields[] = {
 *         API_FIELD("revision", "count", st_entry, revision, .required = true),
 *         API_FIELD("inverts", "count", st_entry, inverts, .zero_is_none = true,
 *                   .doc = "The revision that it undid or redid."),
 *         API_FIELD_MADE_OF("action", "#action", st_entry, action, write_action, .required = true),
 *         API_FIELD_RECORD("created", "#counted", st_entry, tally.created, &api_counted_record),
 *     };
 *     const api_record api_entry_record = API_RECORD("entry", fields);
 *
 * The members are written in the order of the rows. A member without a value is null if it is
 * required, else it is left out. */
#ifndef HE_API_JSON_RECORD_H
#define HE_API_JSON_RECORD_H

#include "api/json/json_out.h"

#include <stddef.h>

/* The C type of a value in the struct. The macro API_FORM determines it. */
typedef enum api_form {
    /* The value is not a simple one: the row's function `write` writes it, or its table `record`
     * describes it. */
    API_FORM_NONE,
    API_FORM_BOOL,
    API_FORM_INT,
    API_FORM_I64,
    API_FORM_U32,
    API_FORM_U64,
    API_FORM_DOUBLE,
    API_FORM_TEXT,  /* a const char *; NULL means that there is no value */
    API_FORM_CHARS, /* an array of char */
    API_FORM_TEXTS, /* a list of texts that ends in NULL; NULL means that there is no list */
    API_FORM_VEC3
} api_form;

typedef struct api_record api_record;

typedef struct api_field {
    const char *name;
    const char *type; /* type of the schema, written as api/describe/schema_rows.h says */
    bool required;
    const char *doc; /* description in the OpenAPI document, may be NULL */
    api_form form;
    size_t offset;     /* offset of the value in the struct; 0 is also that of the whole struct */
    bool zero_is_none; /* true if 0 or "" means that there is no value */
    /* 1 + the offset of a bool in the struct that says whether there is a value (API_KNOWN); 0:
     * there always is one */
    size_t known;
    /* Computes the value from what lies at the offset, and writes it after the member's name; NULL
     * if no function is needed. */
    void (*write)(api_out *out, const void *at);
    /* The table that describes the struct at the offset, which is written as an object; or NULL. */
    const api_record *record;
} api_field;

/* All members of an object that is written from a struct. */
struct api_record {
    const char *schema;
    const api_field *fields;
    size_t count;
};

#define API_FORM(lvalue) \
    _Generic((lvalue),                                                                             \
        bool: API_FORM_BOOL,                                                                       \
        int: API_FORM_INT,                                                                         \
        int64_t: API_FORM_I64,                                                                     \
        uint32_t: API_FORM_U32,                                                                    \
        uint64_t: API_FORM_U64,                                                                    \
        double: API_FORM_DOUBLE,                                                                   \
        const char *: API_FORM_TEXT,                                                               \
        char *: API_FORM_CHARS,                                                                    \
        const char *const *: API_FORM_TEXTS,                                                       \
        he_vec3: API_FORM_VEC3)
/* Makes a row of a table whose value is a member of a struct. */
#define API_FIELD(name_, type_, struct_, member_, ...)                          \
    {                                                                           \
        .name = (name_), .type = (type_), .offset = offsetof(struct_, member_), \
        .form = API_FORM(((struct_ *)0)->member_), __VA_ARGS__                  \
    }
/* Makes a row of a table whose value a function computes and writes from the whole struct. */
#define API_FIELD_MADE(name_, type_, write_, ...)                        \
    {                                                                    \
        .name = (name_), .type = (type_), .write = (write_), __VA_ARGS__ \
    }
/* Makes a row of a table whose value a function computes and writes from one member of the struct;
 * the function gets a pointer to that member. */
#define API_FIELD_MADE_OF(name_, type_, struct_, member_, write_, ...)                             \
    {                                                                                              \
        .name = (name_), .type = (type_), .offset = offsetof(struct_, member_), .write = (write_), \
        __VA_ARGS__                                                                                \
    }
/* Makes a row of a table whose value is an object: the member of the struct is a struct itself, and
 * another table describes it. */
#define API_FIELD_RECORD(name_, type_, struct_, member_, record_, ...)          \
    {                                                                           \
        .name = (name_), .type = (type_), .offset = offsetof(struct_, member_), \
        .record = (record_), __VA_ARGS__                                        \
    }
/* Makes a table of all rows of an array. */
#define API_RECORD(schema_, fields_)                              \
    {                                                             \
        (schema_), (fields_), sizeof(fields_) / sizeof *(fields_) \
    }
#define API_KNOWN(struct_, member_) (offsetof(struct_, member_) + 1)

/* Writes the members of the struct at `value` into an object that the caller has begun. */
void api_record_members(api_out *out, const api_record *record, const void *value);
/* Writes the struct at `value` as an object. */
void api_record_write(api_out *out, const api_record *record, const void *value);

/* Returns true if the C type of the row's value can be written as the row's type in the OpenAPI
 * document. A test checks all rows. */
bool api_field_fits(const api_field *field);

#endif
