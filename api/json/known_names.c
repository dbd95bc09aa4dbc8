#include "api/json/known_names.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 64 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Returns true if one of the words of `text`, which '_' separates, is `word`, which has `length`
 * bytes. */
static bool has_word(const char *text, const char *word, size_t length)
{
    while (true) {
        size_t size = strcspn(text, "_");
        if (size == length && memcmp(text, word, length) == 0) {
            return true;
        }
        if (text[size] == '\0') {
            return false;
        }
        text += size + 1;
    }
}

static bool are_words_of(const char *text, const char *other)
{
    while (true) {
        size_t size = strcspn(text, "_");
        if (!has_word(other, text, size)) {
            return false;
        }
        if (text[size] == '\0') {
            return true;
        }
        text += size + 1;
    }
}

size_t api_name_distance(const char *a, const char *b)
{
    size_t m = strlen(a), n = strlen(b);
    if (m > LONGEST || n > LONGEST) {
        return SIZE_MAX;
    }
    if (m == n && strcmp(a, b) != 0 && are_words_of(a, b) && are_words_of(b, a)) {
        return 1;
    }
    /* rows[i % 3][j] is the distance between the first i letters of the name `a` and the first j
     * letters of the name `b`. */
    size_t rows[3][LONGEST + 1];
    for (size_t j = 0; j <= n; j++) {
        rows[0][j] = j;
    }
    for (size_t i = 1; i <= m; i++) {
        size_t *row = rows[i % 3];
        const size_t *above = rows[(i - 1) % 3], *above_that = rows[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t replaced = above[j - 1] + (a[i - 1] != b[j - 1]);
            row[j] = least(replaced, 1 + least(above[j], row[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = least(row[j], above_that[j - 2] + 1);
            }
        }
    }
    return rows[m % 3][n];
}

void api_known_names_add(api_known_names *known, const char *name)
{
    size_t distance = api_name_distance(known->wanted, name);
    /* The allowed distance grows with the length of the name: "cub" is near enough to "cube", but
     * "ab" is not near enough to "cd". */
    size_t most = (strlen(known->wanted) + 2) / 4;
    if (distance <= most && (known->nearest == NULL || distance < known->distance)) {
        known->nearest = name;
        known->distance = distance;
    }
    size_t room = sizeof known->list - known->length;
    if (known->left_out > 0 || strlen(name) + sizeof ", , ..." > room) {
        known->left_out++;
        return;
    }
    known->length += (size_t)snprintf(known->list + known->length, room, "%s%s",
                                      known->length > 0 ? ", " : "", name);
}

const char *api_known_names_text(api_known_names *known)
{
    known->text[0] = '\0';
    if (known->nearest != NULL) {
        snprintf(known->text, sizeof known->text, "; did you mean \"%s\"?", known->nearest);
    } else if (known->length > 0) {
        snprintf(known->text, sizeof known->text, "; there %s %s%s",
                 strchr(known->list, ',') != NULL ? "are" : "is", known->list,
                 known->left_out > 0 ? ", ..." : "");
    }
    return known->text;
}
