/* notes.h - warnings of a reader or writer: content that it ignored, or could not write.
 *
 * A note has a code and a subject; another occurrence with that code and subject is only counted.
 * The places in the input of the first HE_NOTE_SPOTS occurrences are kept. There is room for
 * HE_NOTES notes, and no memory is allocated; `more` counts the occurrences that found no room. */
#ifndef HE_FORMAT_TEXT_NOTES_H
#define HE_FORMAT_TEXT_NOTES_H

#include "base/status.h"

#include <stddef.h>

enum { HE_NOTES = 32, HE_NOTE_SUBJECT = 80, HE_NOTE_SPOTS = 100 };

typedef struct he_note {
    const char *code;              /* a stable slug, static */
    const char *text;              /* one sentence without the subject; a string literal */
    char subject[HE_NOTE_SUBJECT]; /* what the warning is about: printable ASCII, may be "" */
    uint64_t count;                /* how often it occurred */
    he_place place;                /* unit of `at` */
    uint64_t at;                   /* line or byte of the first occurrence */
} he_note;

/* One occurrence of a warning, as a reader or writer reports it. */
typedef struct he_occurrence {
    const char *code;    /* a stable slug, static */
    const char *text;    /* one sentence without the subject, static */
    const char *subject; /* what it is about; NULL if there is nothing to name */
    size_t length;       /* bytes of the subject, which need not end in NUL */
    he_place place;      /* HE_PLACE_NONE if it has no place in the file */
    uint64_t at;
} he_occurrence;

/* The place of one occurrence that a note counts. */
typedef struct he_note_spot {
    size_t note; /* index of the note */
    uint64_t at;
} he_note_spot;

typedef struct he_notes {
    he_note items[HE_NOTES];
    size_t count;
    uint64_t more;
    he_note_spot spots[HE_NOTE_SPOTS]; /* places of the first occurrences of all notes together */
    size_t spot_count;
} he_notes;

/* Adds one occurrence of a warning. Its subject is cut to fit and made printable. */
void he_notes_add(he_notes *notes, const he_occurrence *seen);
/* Adds `count` occurrences of a warning that have no place in the file; nothing if `count` is 0. */
void he_notes_add_count(he_notes *notes, const char *code, const char *text, uint64_t count);
/* Writes a text such as "ignored: unknown keyword 'xyz', 3 times, first on line 7". */
size_t he_note_text(const he_note *note, char *text, size_t size);

/* Copies bytes of an input into a message: at most size - 1 bytes. Bytes other than printable ASCII
 * become '?'. */
void he_quote(const char *begin, const char *end, char *text, size_t size);

#endif
