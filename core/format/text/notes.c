#include "format/text/notes.h"

#include <stdio.h>
#include <string.h>

void he_quote(const char *begin, const char *end, char *text, size_t size)
{
    size_t length = 0;
    for (const char *p = begin; p < end && length + 1 < size; p++) {
        text[length++] = *p >= 0x20 && *p < 0x7F ? *p : '?';
    }
    text[length] = '\0';
}

static void add_spot(he_notes *notes, size_t note, const he_occurrence *seen)
{
    if (seen->place != HE_PLACE_NONE && notes->spot_count < HE_NOTE_SPOTS) {
        notes->spots[notes->spot_count++] = (he_note_spot){note, seen->at};
    }
}

void he_notes_add(he_notes *notes, const he_occurrence *seen)
{
    char name[HE_NOTE_SUBJECT];
    const char *subject = seen->subject;
    he_quote(subject, subject == NULL ? NULL : subject + seen->length, name, sizeof name);
    for (size_t i = 0; i < notes->count; i++) {
        he_note *note = &notes->items[i];
        if (strcmp(note->code, seen->code) == 0 && strcmp(note->subject, name) == 0) {
            note->count++;
            add_spot(notes, i, seen);
            return;
        }
    }
    if (notes->count == HE_NOTES) {
        notes->more++;
        return;
    }
    he_note *note = &notes->items[notes->count++];
    *note = (he_note){
        .code = seen->code, .text = seen->text, .count = 1, .place = seen->place, .at = seen->at};
    memcpy(note->subject, name, sizeof name);
    add_spot(notes, notes->count - 1, seen);
}

void he_notes_add_count(he_notes *notes, const char *code, const char *text, uint64_t count)
{
    size_t before = notes->count;
    if (count == 0) {
        return;
    }
    he_notes_add(notes, &(he_occurrence){.code = code, .text = text});
    if (notes->count > before) {
        notes->items[before].count = count;
    }
}

size_t he_note_text(const he_note *note, char *text, size_t size)
{
    char subject[HE_NOTE_SUBJECT + 4] = "", times[40] = "", where[48] = "";
    if (note->subject[0] != '\0') {
        snprintf(subject, sizeof subject, " '%s'", note->subject);
    }
    if (note->count > 1) {
        snprintf(times, sizeof times, ", %llu times", (unsigned long long)note->count);
    }
    if (note->place != HE_PLACE_NONE) {
        snprintf(where, sizeof where, ",%s %s %llu", note->count > 1 ? " first" : "",
                 note->place == HE_PLACE_LINE ? "on line" : "at byte",
                 (unsigned long long)note->at);
    }
    int length = snprintf(text, size, "%s%s%s%s", note->text, subject, times, where);
    return length < 0 ? 0 : (size_t)length < size ? (size_t)length : size - 1;
}
