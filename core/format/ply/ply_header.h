/* ply_header.h - parses the header of a PLY file. */
#ifndef HE_FORMAT_PLY_PLY_HEADER_H
#define HE_FORMAT_PLY_PLY_HEADER_H

#include "format/text/lines.h"
#include "format/text/warnings.h"
#include "mesh/column.h"

/* The most elements and properties that a header may declare, so that the work for each row stays
 * small. */
enum { HE_PLY_ELEMENTS = 64, HE_PLY_PROPERTIES = 1024 };

typedef enum he_ply_encoding {
    HE_PLY_UNKNOWN,
    HE_PLY_ASCII,
    HE_PLY_LITTLE_ENDIAN,
    HE_PLY_BIG_ENDIAN
} he_ply_encoding;

typedef enum he_ply_type {
    HE_PLY_INT8,
    HE_PLY_UINT8,
    HE_PLY_INT16,
    HE_PLY_UINT16,
    HE_PLY_INT32,
    HE_PLY_UINT32,
    HE_PLY_FLOAT,
    HE_PLY_DOUBLE,
    HE_PLY_TYPE_COUNT
} he_ply_type;

size_t he_ply_type_bytes(he_ply_type type);
/* Returns the name of a type of the format, "char" to "double". */
const char *he_ply_type_name(he_ply_type type);
/* Returns the type of attribute that can hold all values of a type of the format. */
he_type he_ply_type_column(he_ply_type type);

typedef struct he_ply_property {
    /* The property's name, made printable, and cut if it does not fit. */
    char name[HE_WARNING_SUBJECT];
    bool nameable; /* true if an attribute can have this name */
    bool list;
    /* type: type of the values; count: if the property is a list, the type of its length. */
    he_ply_type count, type;
    uint64_t line;
} he_ply_property;

typedef struct he_ply_element {
    char name[HE_WARNING_SUBJECT];
    uint64_t rows;
    /* `first` is the index in the header of the element's first property, `properties` is the
     * number of its properties */
    size_t first, properties;
    bool lists;    /* true if some property is a list, so that rows differ in length */
    size_t stride; /* number of bytes of a row, if no property is a list */
    uint64_t line;
} he_ply_element;

/* {0} is empty. */
typedef struct he_ply_header {
    bool begun, ended;
    /* What follows "hedge corners" in the comment that begins with these words. */
    char corners[HE_WARNING_SUBJECT];
    he_ply_encoding encoding;
    he_ply_element *elements;
    size_t count, capacity;
    he_ply_property *properties;
    size_t property_count, property_capacity;
} he_ply_header;

void he_ply_header_clear(he_ply_header *header);
/* Reads the next line of the header. Must not be called after the line end_header.
 * Returns HE_SYNTAX, HE_BAD_VALUE or HE_UNSUPPORTED if the line is not valid.
 * Returns HE_LIMIT if there are too many elements or properties.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_header_read(he_ply_header *header, const he_line *line,
                                          he_error *err);
/* Returns the index, within the element, of its property of this name. Returns element->properties
 * if there is none. */
size_t he_ply_find(const he_ply_header *header, const he_ply_element *element, const char *name);

#endif
