/* json_lexer.h - splits a JSON text into tokens; the only implementation of its grammar.
 *
 * The text must be valid by RFC 8259: no byte order mark, no leading zero, no number too large for
 * a double, no raw control character, no \u0000, no lone surrogate, nothing but UTF-8 in strings,
 * nothing after the value. The lexer does not check that names are unique in an object, which would
 * take memory.
 *
 * The text comes whole, or in pieces that may be cut anywhere:
 *
 *     he_lexer x;
 *     he_lexer_init(&x, &carry);            // NULL: one piece is the whole text
 *     for each piece {
 *         he_lexer_feed(&x, bytes, length);
 *         while ((token = he_lexer_next(&x)) != HE_TOKEN_CUT) { ... }
 *     }
 *
 * The lexer allocates no memory and does not recurse. Its position can be read: x.depth arrays and
 * objects are open, x.frames[d] is the position in each of them, and he_lexer_place returns the
 * offset of the next byte. The caller decides what a token means. It may test a value before it is
 * read (he_lexer_value_ahead) and refuse it by its first byte, and it may read a whole array of
 * numbers at once (he_lexer_take_numbers). */
#ifndef HE_FORMAT_TEXT_JSON_LEXER_H
#define HE_FORMAT_TEXT_JSON_LEXER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    HE_JSON_DEPTH = 128,     /* most open arrays and objects */
    HE_JSON_CARRY = 1024,    /* the most bytes of a number in a text that comes in pieces */
    HE_JSON_NAMES = 512,     /* most bytes of the names on a path, if the text comes in pieces */
    HE_JSON_STRING = 1 << 16 /* a string with more bytes comes as several tokens (HE_TOKEN_PART) */
};

typedef enum he_token {
    HE_TOKEN_CUT,   /* all bytes of the piece were read, and more may come */
    HE_TOKEN_END,   /* the text, which came in one piece, has ended */
    HE_TOKEN_FAULT, /* the text has the fault x.fault at x.fault_place; the lexer cannot go on */
    HE_TOKEN_PART,  /* HE_JSON_STRING bytes of a string; the next token continues it */
    HE_TOKEN_KEY, /* a member's name and its colon; the last frame (he_lexer_frame) has the name */
    HE_TOKEN_STRING,
    HE_TOKEN_NUMBER, /* the number is x.number, x.length bytes long */
    HE_TOKEN_TRUE,
    HE_TOKEN_FALSE,
    HE_TOKEN_NULL,
    HE_TOKEN_OBJECT, /* an opening bracket; the last frame stands for the object */
    HE_TOKEN_ARRAY,
    HE_TOKEN_CLOSE /* a closing bracket; x.frames[x.depth] is still the frame of what it closes */
} he_token;

/* The kinds of faults. A fault is reported at the byte where its token begins; HE_FAULT_STRING
 * at the byte where the bad character begins; and a name or number that is too long at the first
 * byte beyond the limit. */
typedef enum he_fault {
    HE_FAULT_NONE,
    HE_FAULT_VALUE,      /* no value begins here */
    HE_FAULT_ENDS,       /* the text ends where a value is expected */
    HE_FAULT_NAME,       /* a name of a member is expected, but none begins here */
    HE_FAULT_COLON,      /* no ':' here */
    HE_FAULT_ITEM,       /* neither ',' nor ']' here */
    HE_FAULT_MEMBER,     /* neither ',' nor '}' here */
    HE_FAULT_FOLLOWS,    /* the value is followed by more text */
    HE_FAULT_DEPTH,      /* deeper than x.depth_most */
    HE_FAULT_STRING,     /* x.wrong describes the fault */
    HE_FAULT_NUMBER,     /* not a number */
    HE_FAULT_NOT_FINITE, /* beyond the range of doubles */
    HE_FAULT_LONG_NUMBER,
    HE_FAULT_LONG_NAME
} he_fault;

typedef enum he_lexer_state {
    HE_JSON_VALUE,        /* a value must follow */
    HE_JSON_VALUE_OR_END, /* after '[' */
    HE_JSON_NAME_OR_END,  /* after '{' */
    HE_JSON_NAME,         /* after ',' in an object */
    HE_JSON_AFTER,        /* ',' or a closing bracket */
    HE_JSON_DONE,         /* only blanks may follow */
    HE_JSON_IN_STRING,    /* in this state and all below, a token is not complete */
    HE_JSON_IN_NUMBER,
    HE_JSON_IN_WORD,
    HE_JSON_IN_NAME,
    HE_JSON_COLON
} he_lexer_state;

/* An open array or object, and the lexer's position in it. */
typedef struct he_lexer_frame {
    bool object;
    uint32_t names; /* bytes that the names of the enclosing objects take in the carry buffer */
    size_t index;   /* index of the item or member at which the lexer is */
    /* The name of the member as it stands in the text, without quotes. It is NULL before it is
     * read, and also if a piece of the text ended inside it and `carry` has no room for it. */
    const char *name;
    size_t name_length;
} he_lexer_frame;

/* A buffer for the bytes of names and numbers that must be kept when the piece of the text that
 * contains them is freed. */
typedef struct he_lexer_carry {
    char bytes[HE_JSON_CARRY]; /* first bytes of a number or character cut by the end of a piece */
    size_t length;
    char names[HE_JSON_NAMES];
} he_lexer_carry;

/* The state of a lexer. All code may read the fields; the caller may set only the limits
 * depth_most, number_most and name_most. */
typedef struct he_lexer {
    /* The piece of text being read is [begin, end); `at` is the next byte to read. */
    const char *begin, *at, *end;
    uint64_t offset; /* offset of the piece in the text */
    /* Keeps bytes between pieces; NULL if the piece is the whole text. */
    he_lexer_carry *carry;
    he_lexer_state state;

    size_t depth_most;  /* most open arrays and objects, at most HE_JSON_DEPTH (the default) */
    size_t number_most; /* most bytes of a number in a text in pieces, at most HE_JSON_CARRY */
    size_t name_most;   /* most bytes of a name as it stands in the text */

    uint64_t start; /* offset of the token's first byte in the text */
    double number;
    size_t length;
    /* word being read (true, false, null): its first `matched` letters were read */
    const char *word;
    size_t matched;
    size_t name_length; /* how many bytes of the present member name are in the carry buffer */
    bool name_lost;     /* true if the present member name did not fit into the carry buffer */

    he_fault fault;
    uint64_t fault_place;
    const char *wrong;

    size_t depth;
    he_lexer_frame frames[HE_JSON_DEPTH];
} he_lexer;

/* Initialises a lexer. `carry` is borrowed; it is NULL if the text comes in one piece. */
void he_lexer_init(he_lexer *x, he_lexer_carry *carry);
/* Feeds the next piece of the text, at the beginning and whenever he_lexer_next returns
 * HE_TOKEN_CUT. The piece is borrowed until the next one is fed. */
void he_lexer_feed(he_lexer *x, const char *bytes, size_t length);

he_token he_lexer_next(he_lexer *x);

/* Skips blanks and a comma. Returns true if after this a value begins at x.at, or the grammar
 * allows nothing but a value there. Returns false if the piece ends before the value or inside a
 * token, or
 * if something other than a value must follow. */
bool he_lexer_value_ahead(he_lexer *x);
/* These functions read a whole array at once, if it is the next value: he_lexer_take_numbers at
 * most `most` numbers, he_lexer_take_indices at most `most` whole numbers below HE_DEAD in decimal
 * digits. They return how many numbers the array has. If the next value is no such array, or the
 * piece does not contain the whole array, they read nothing and return 0. */
size_t he_lexer_take_numbers(he_lexer *x, double *out, size_t most);
size_t he_lexer_take_indices(he_lexer *x, uint32_t *out, size_t most);

/* Returns the offset of the next byte in the whole text. */
static inline uint64_t he_lexer_place(const he_lexer *x)
{
    return x->offset + (uint64_t)(x->at - x->begin);
}
/* Returns a sentence that explains the fault x.fault. */
const char *he_lexer_fault_text(const he_lexer *x);
/* Writes the JSON pointer (RFC 6901) of the value at the lexer's position. If a member's name on
 * the way is not known or does not fit, the pointer ends before that name: it then names an array
 * or object that contains the position. */
void he_lexer_pointer(const he_lexer *x, char *out, size_t size);

#endif
