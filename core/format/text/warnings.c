#include "format/text/warnings.h"

#include <assert.h>
#include <stdbool.h>
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

static void add_spot(he_warnings *warnings, size_t warning, const he_occurrence *seen)
{
    if (seen->place != HE_PLACE_NONE && warnings->spot_count < HE_WARNING_SPOTS) {
        warnings->spots[warnings->spot_count++] = (he_warning_spot){warning, seen->at};
    }
}

/* Returns true if a text has the form that warnings.h describes. */
static bool is_sentence(const char *text, bool has_subject)
{
    const char *mark = strchr(text, '%');
    return strlen(text) < HE_WARNING_SENTENCE && strchr(text, ';') == NULL &&
           (mark != NULL) == has_subject && (mark == NULL || strchr(mark + 1, '%') == NULL);
}

void he_warnings_add(he_warnings *warnings, const he_occurrence *seen)
{
    assert(is_sentence(seen->text, seen->subject != NULL));
    char name[HE_WARNING_SUBJECT];
    const char *subject = seen->subject;
    he_quote(subject, subject == NULL ? NULL : subject + seen->length, name, sizeof name);
    for (size_t i = 0; i < warnings->count; i++) {
        he_warning *warning = &warnings->items[i];
        if (strcmp(warning->code, seen->code) == 0 && strcmp(warning->subject, name) == 0) {
            warning->count++;
            add_spot(warnings, i, seen);
            return;
        }
    }
    if (warnings->count == HE_WARNINGS) {
        warnings->more++;
        return;
    }
    he_warning *warning = &warnings->items[warnings->count++];
    *warning = (he_warning){
        .code = seen->code, .text = seen->text, .count = 1, .place = seen->place, .at = seen->at};
    memcpy(warning->subject, name, sizeof name);
    add_spot(warnings, warnings->count - 1, seen);
}

void he_warnings_add_count(he_warnings *warnings, const char *code, const char *text,
                           uint64_t count)
{
    size_t before = warnings->count;
    if (count == 0) {
        return;
    }
    he_warnings_add(warnings, &(he_occurrence){.code = code, .text = text});
    if (warnings->count > before) {
        warnings->items[before].count = count;
    }
}

size_t he_warning_text(const he_warning *warning, char *text, size_t size)
{
    char subject[HE_WARNING_SUBJECT + 4] = "", times[40] = "", where[48] = "";
    int before = (int)strcspn(warning->text, "%");
    const char *after = warning->text + before;
    if (*after == '%') {
        const char *quote = warning->subject[0] != '\0' ? "'" : "";
        const char *name = warning->subject[0] != '\0' ? warning->subject : "(unnamed)";
        snprintf(subject, sizeof subject, "%s%s%s", quote, name, quote);
        after++;
    }
    if (warning->count > 1) {
        snprintf(times, sizeof times, ", %llu times", (unsigned long long)warning->count);
    }
    if (warning->place != HE_PLACE_NONE) {
        snprintf(where, sizeof where, ",%s %s %llu", warning->count > 1 ? " first" : "",
                 warning->place == HE_PLACE_LINE ? "on line" : "at byte",
                 (unsigned long long)warning->at);
    }
    int length =
        snprintf(text, size, "%.*s%s%s%s%s", before, warning->text, subject, after, times, where);
    return length < 0 ? 0 : (size_t)length < size ? (size_t)length : size - 1;
}
