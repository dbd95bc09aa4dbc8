/* warnings.h - warnings of a reader or writer about data that it ignored, or could not write.
 *
 * A warning has a code and a subject; another occurrence with that code and subject is only
 * counted. The places in the input of the first HE_WARNING_SPOTS occurrences are kept. There is
 * room for HE_WARNINGS warnings, and no memory is allocated; `more` counts the occurrences that
 * found no room. */
#ifndef HE_FORMAT_TEXT_WARNINGS_H
#define HE_FORMAT_TEXT_WARNINGS_H

#include "base/status.h"

#include <stddef.h>

enum { HE_WARNINGS = 32, HE_WARNING_SUBJECT = 80, HE_WARNING_SPOTS = 100 };

typedef struct he_warning {
    const char *code; /* a stable slug, static */
    const char *text; /* one sentence, which the subject completes; a string literal */
    char subject[HE_WARNING_SUBJECT]; /* what the warning is about: printable ASCII, may be "" */
    uint64_t count;                   /* how often it occurred */
    he_place place;                   /* unit of `at` */
    uint64_t at;                      /* line or byte of the first occurrence */
} he_warning;

/* One occurrence of a warning, as a reader or writer reports it. */
typedef struct he_occurrence {
    const char *code;    /* a stable slug, static */
    const char *text;    /* one sentence, which the subject completes; a string literal */
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

/* Adds one occurrence of a warning. Its subject is cut to fit and made printable. */
void he_warnings_add(he_warnings *warnings, const he_occurrence *seen);
/* Adds `count` occurrences of a warning that have no place in the file; does nothing if `count` is
 * 0. */
void he_warnings_add_count(he_warnings *warnings, const char *code, const char *text,
                           uint64_t count);
/* Writes a text such as "ignored: unknown keyword 'xyz', 3 times, first on line 7". */
size_t he_warning_text(const he_warning *warning, char *text, size_t size);

/* Copies bytes of an input into a message: at most size - 1 bytes. Bytes other than printable ASCII
 * become '?'. */
void he_quote(const char *begin, const char *end, char *text, size_t size);

#endif
