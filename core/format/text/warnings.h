/* warnings.h - warnings of a reader or writer about data that it ignored, or could not write.
 *
 * A warning has a code and a subject; another occurrence with that code and subject is only
 * counted. The places in the input of the first HE_WARNING_SPOTS occurrences are kept. There is
 * room for HE_WARNINGS warnings, and no memory is allocated; `more` counts the occurrences that
 * found no room.
 *
 * The text of a warning is a sentence about one occurrence, without a capital and a full stop: its
 * grammatical subject comes first, and it says what was lost and why. The place of the warning's
 * subject is marked by one '%':
 *
 *     "unknown keyword % is ignored"   is shown as   unknown keyword 'xyz' is ignored, 3 times
 *
 * A warning with a subject needs this '%'; in the text of one without a subject no '%' may occur.
 * A semicolon may not occur either, because clients get warnings as a list that it separates. */
#ifndef HE_FORMAT_TEXT_WARNINGS_H
#define HE_FORMAT_TEXT_WARNINGS_H

#include "base/status.h"

#include <stddef.h>

enum {
    HE_WARNINGS = 32,
    HE_WARNING_SUBJECT = 80,
    HE_WARNING_SPOTS = 100,
    HE_WARNING_SENTENCE = 160, /* the most bytes of a warning's text, with its NUL */
    /* room for all that he_warning_text() writes of any warning: the subject is quoted, and a count
     * and a place follow */
    HE_WARNING_TEXT = HE_WARNING_SENTENCE + HE_WARNING_SUBJECT + 80
};

typedef struct he_warning {
    const char *code; /* a stable slug, static */
    const char *text; /* one sentence, with '%' in place of the subject; a string literal */
    char subject[HE_WARNING_SUBJECT]; /* what the warning is about: printable ASCII, "" if it has no
                                         name */
    uint64_t count;                   /* how often it occurred */
    he_place place;                   /* unit of `at` */
    uint64_t at;                      /* line or byte of the first occurrence */
} he_warning;

/* One occurrence of a warning, as a reader or writer reports it. */
typedef struct he_occurrence {
    const char *code;    /* a stable slug, static */
    const char *text;    /* one sentence, with '%' in place of the subject; a string literal */
    const char *subject; /* what the warning is about; NULL if there is nothing to name */
    size_t length;       /* length in bytes of the subject, which need not end in NUL */
    he_place place;      /* HE_PLACE_NONE if the occurrence has no place in the file */
    uint64_t at;
} he_occurrence;

/* The place of one occurrence that a warning counts. */
typedef struct he_warning_spot {
    size_t warning; /* index of the warning */
    uint64_t at;
} he_warning_spot;

typedef struct he_warnings {
    he_warning items[HE_WARNINGS];
    size_t count;
    uint64_t more;
    /* places of the first occurrences of all warnings together */
    he_warning_spot spots[HE_WARNING_SPOTS];
    size_t spot_count;
} he_warnings;

/* Adds one occurrence of a warning. Its subject is cut to fit and made printable. Asserts that the
 * text has the form described above. */
void he_warnings_add(he_warnings *warnings, const he_occurrence *seen);
/* Adds `count` occurrences of a warning that has no subject and no place in the file; does nothing
 * if `count` is 0. */
void he_warnings_add_count(he_warnings *warnings, const char *code, const char *text,
                           uint64_t count);
/* Writes a text such as "unknown keyword 'xyz' is ignored, 3 times, first on line 7", cut to fit.
 * An empty subject is shown as (unnamed). Returns the length of the text. */
size_t he_warning_text(const he_warning *warning, char *text, size_t size);

/* Copies bytes of an input into a message: at most size - 1 bytes. Bytes other than printable ASCII
 * become '?'. */
void he_quote(const char *begin, const char *end, char *text, size_t size);

#endif
