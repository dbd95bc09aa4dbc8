/* json_lexer.h - the tokens of a JSON text: the one reader of its grammar.
 *
 * The text is held to the letter of RFC 8259: no byte order mark, no leading zero, no number beyond
 * doubles, no raw control character, no \u0000, no lone surrogate, nothing but UTF-8 in strings,
 * nothing after the value. Not held: names that an object has twice, which takes memory.
 *
 * It comes whole, or in pieces that may be cut anywhere:
 *
 *     he_lexer x;
 *     he_lexer_init(&x, &carry);            // NULL: one piece is the whole text
 *     for each piece {
 *         he_lexer_feed(&x, bytes, length);
 *         while ((token = he_lexer_next(&x)) != HE_TOKEN_CUT) { ... }
 *     }
 *
 * The lexer takes no memory and does not recurse. It knows its place: x.depth arrays and objects
 * are open, x.frames[d] says where in them it is, he_lexer_place which byte comes next. What a
 * token means is for the caller to say, who may look at a value before it is read
 * (he_lexer_value_ahead) and refuse it by its first byte, and may take a row of numbers at once. */
#ifndef HE_FORMAT_TEXT_JSON_LEXER_H
#define HE_FORMAT_TEXT_JSON_LEXER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    HE_JSON_DEPTH = 128,     /* open arrays and objects at most */
    HE_JSON_CARRY = 1024,    /* bytes of a number in a text that comes in pieces */
    HE_JSON_NAMES = 512,     /* bytes of the names that lead to a value in such a text */
    HE_JSON_STRING = 1 << 16 /* bytes of a string after which it is interrupted */
};

typedef enum he_token {
    HE_TOKEN_CUT,   /* the piece is used up, and the text is not known to have ended */
    HE_TOKEN_END,   /* a text in one piece has ended */
    HE_TOKEN_FAULT, /* x.fault stands at x.fault_place; the lexer only waits to be dropped */
    HE_TOKEN_PART,  /* HE_JSON_STRING bytes of a string; the rest of it is the next token */
    HE_TOKEN_KEY,   /* a member's name and its colon: the name of the innermost frame */
    HE_TOKEN_STRING,
    HE_TOKEN_NUMBER, /* x.number, x.length bytes long */
    HE_TOKEN_TRUE,
    HE_TOKEN_FALSE,
    HE_TOKEN_NULL,
    HE_TOKEN_OBJECT, /* an opening bracket; its frame is the innermost one */
    HE_TOKEN_ARRAY,
    HE_TOKEN_CLOSE /* a closing bracket; x.frames[x.depth] is still what it was */
} he_token;

/* What may be wrong. The place is where the token begins, for HE_FAULT_STRING where the character
 * does, and for what is too long the first byte that is too much. */
typedef enum he_fault {
    HE_FAULT_NONE,
    HE_FAULT_VALUE,      /* no value here */
    HE_FAULT_ENDS,       /* the text ends where a value is expected */
    HE_FAULT_NAME,       /* no name of a member here */
    HE_FAULT_COLON,      /* no ':' here */
    HE_FAULT_ITEM,       /* neither ',' nor ']' here */
    HE_FAULT_MEMBER,     /* neither ',' nor '}' here */
    HE_FAULT_FOLLOWS,    /* something follows the value */
    HE_FAULT_DEPTH,      /* deeper than x.depth_most */
    HE_FAULT_STRING,     /* x.wrong says what */
    HE_FAULT_NUMBER,     /* not a number */
    HE_FAULT_NOT_FINITE, /* beyond doubles */
    HE_FAULT_LONG_NUMBER,
    HE_FAULT_LONG_NAME
} he_fault;

typedef enum he_lexer_state {
    HE_JSON_VALUE,        /* a value is due */
    HE_JSON_VALUE_OR_END, /* after '[' */
    HE_JSON_NAME_OR_END,  /* after '{' */
    HE_JSON_NAME,         /* after ',' in an object */
    HE_JSON_AFTER,        /* ',' or a closing bracket */
    HE_JSON_DONE,         /* blanks */
    HE_JSON_IN_STRING,    /* within a token, from here on */
    HE_JSON_IN_NUMBER,
    HE_JSON_IN_WORD,
    HE_JSON_IN_NAME,
    HE_JSON_COLON
} he_lexer_state;

/* An open array or object, and where in it the lexer is. */
typedef struct he_lexer_frame {
    bool object;
    uint32_t names;   /* bytes of the carried names below */
    size_t index;     /* of the item or member */
    const char *name; /* of the member, as it stands in the text without quotes; NULL before it is
                       * read, and where it is carried and found no room */
    size_t name_length;
} he_lexer_frame;

/* What is kept of a text whose pieces go away. */
typedef struct he_lexer_carry {
    char bytes[HE_JSON_CARRY]; /* of a number or a character that is cut */
    size_t length;
    char names[HE_JSON_NAMES];
} he_lexer_carry;

/* All may read, the three limits are the caller's to set. */
typedef struct he_lexer {
    const char *begin, *at, *end; /* the piece, and the next byte */
    uint64_t offset;              /* of the piece in the text */
    he_lexer_carry *carry;        /* NULL: the piece is the whole text */
    he_lexer_state state;

    size_t depth_most;  /* at most HE_JSON_DEPTH, as at first */
    size_t number_most; /* bytes; asked only of a text in pieces, at most HE_JSON_CARRY */
    size_t name_most;   /* bytes as they stand */

    uint64_t start; /* of the token */
    double number;
    size_t length;
    const char *word; /* that a piece cuts, its first `matched` letters seen */
    size_t matched;
    size_t name_length; /* carried so far */
    bool name_lost;     /* it found no room */

    he_fault fault;
    uint64_t fault_place;
    const char *wrong;

    size_t depth;
    he_lexer_frame frames[HE_JSON_DEPTH];
} he_lexer;

/* `carry` is borrowed. */
void he_lexer_init(he_lexer *x, he_lexer_carry *carry);
/* The next piece, after HE_TOKEN_CUT; it is borrowed up to the next one. */
void he_lexer_feed(he_lexer *x, const char *bytes, size_t length);

he_token he_lexer_next(he_lexer *x);

/* Does the byte *x.at begin a value, or stand where only a value may? Passes blanks and the comma
 * before it. False where the piece ends first, within a token, and where something else is due. */
bool he_lexer_value_ahead(he_lexer *x);
/* Takes an array of at most `most` numbers, or of at most `most` whole numbers below HE_DEAD in
 * decimal digits, where a value is ahead. Returns how many they are; 0, and nothing is taken, where
 * the value is none of these or the piece does not hold it whole. */
size_t he_lexer_take_numbers(he_lexer *x, double *out, size_t most);
size_t he_lexer_take_indices(he_lexer *x, uint32_t *out, size_t most);

/* The byte of the text that comes next. */
static inline uint64_t he_lexer_place(const he_lexer *x)
{
    return x->offset + (uint64_t)(x->at - x->begin);
}
/* A sentence about x.fault. */
const char *he_lexer_fault_text(const he_lexer *x);
/* Writes the JSON pointer (RFC 6901) of the place. It ends early at a name that is not known or
 * does not fit, for a pointer to what holds the value is still true. */
void he_lexer_pointer(const he_lexer *x, char *out, size_t size);

#endif
