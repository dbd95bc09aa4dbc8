#include "json_tokens.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void clear(json_tokens *t)
{
    t->told[0] = '\0';
    t->length = 0;
    t->last = HE_TOKEN_CUT;
}

static void tell(json_tokens *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    size_t room = JSON_TOKENS_TOLD - t->length;
    int size = vsnprintf(t->told + t->length, room, format, arguments);
    va_end(arguments);
    t->length += size < 0 ? 0 : (size_t)size < room ? (size_t)size : room - 1;
}

static void tell_token(json_tokens *t, const he_lexer *x, he_token token)
{
    const he_lexer_frame *frame = x->depth > 0 ? &x->frames[x->depth - 1] : NULL;
    switch (token) {
    case HE_TOKEN_KEY:
        tell(t, "%.*s:", frame->name != NULL ? (int)frame->name_length : 4,
             frame->name != NULL ? frame->name : "lost");
        break;
    case HE_TOKEN_STRING:
        tell(t, "s ");
        break;
    case HE_TOKEN_NUMBER:
        tell(t, "%.17g/%zu ", x->number, x->length);
        break;
    case HE_TOKEN_TRUE:
        tell(t, "true ");
        break;
    case HE_TOKEN_FALSE:
        tell(t, "false ");
        break;
    case HE_TOKEN_NULL:
        tell(t, "null ");
        break;
    case HE_TOKEN_OBJECT:
        tell(t, "{");
        break;
    case HE_TOKEN_ARRAY:
        tell(t, "[");
        break;
    case HE_TOKEN_CLOSE:
        tell(t, ".");
        break;
    case HE_TOKEN_CUT:
    case HE_TOKEN_END:
    case HE_TOKEN_FAULT:
    case HE_TOKEN_PART:
        break;
    }
}

/* Reads tokens until the piece ends, the text ends, or a fault is found. */
static void read_tokens(json_tokens *t, he_lexer *x)
{
    do {
        t->last = he_lexer_next(x);
        tell_token(t, x, t->last);
    } while (t->last != HE_TOKEN_CUT && t->last != HE_TOKEN_END && t->last != HE_TOKEN_FAULT);
    t->fault = t->last == HE_TOKEN_FAULT ? x->fault : HE_FAULT_NONE;
    t->place = t->last == HE_TOKEN_FAULT ? x->fault_place : 0;
}

void json_tokens_of_text(json_tokens *t, const char *text, size_t length)
{
    he_lexer x;
    clear(t);
    he_lexer_init(&x, NULL);
    he_lexer_feed(&x, text, length);
    read_tokens(t, &x);
}

void json_tokens_of_piece(json_tokens *t, he_lexer *x, const char *piece, size_t length)
{
    char *copy = malloc(length > 0 ? length : 1);
    if (copy == NULL) {
        abort();
    }
    memcpy(copy, piece, length);
    he_lexer_feed(x, copy, length);
    read_tokens(t, x);
    free(copy);
}

void json_tokens_of_pieces(json_tokens *t, const char *text, size_t length, uint64_t cuts)
{
    static he_lexer_carry carry;
    he_lexer x;
    size_t from = 0;
    clear(t);
    he_lexer_init(&x, &carry);
    for (size_t to = 1; to <= length && t->last == HE_TOKEN_CUT; to++) {
        if (to == length || (cuts >> (to % 64) & 1) != 0) {
            json_tokens_of_piece(t, &x, text + from, to - from);
            from = to;
        }
    }
    if (t->last == HE_TOKEN_CUT && x.state == HE_JSON_DONE) {
        t->last = HE_TOKEN_END;
    }
}

bool json_tokens_agree(const json_tokens *whole, const json_tokens *pieces)
{
    bool end = pieces->last == HE_TOKEN_CUT
                   ? whole->last == HE_TOKEN_FAULT
                   : whole->last == pieces->last && whole->fault == pieces->fault &&
                         whole->place == pieces->place;
    return end && strcmp(whole->told, pieces->told) == 0;
}
