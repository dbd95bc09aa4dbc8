/* first_cards.h - finds the cards (short descriptions of meshes) that come first in an order, among
 * many that are looked at one after another. Memory is needed only for the cards that are found: a
 * heap keeps the best of those looked at so far, the last of them at its top. */
#ifndef HE_API_READ_FIRST_CARDS_H
#define HE_API_READ_FIRST_CARDS_H

#include "journal/record.h"

typedef struct api_first_cards {
    st_card_page page; /* the order, where the cards begin, and how many are wanted */
    st_card *cards;    /* a heap until api_first_cards_sort */
    size_t count, capacity;
} api_first_cards;

/* Looks at a card. Returns false if memory is out. */
bool api_first_cards_add(api_first_cards *first, const st_card *card);
/* Puts the cards that were found into the order of the page. No card may be added afterwards. */
void api_first_cards_sort(api_first_cards *first);
void api_first_cards_clear(api_first_cards *first);

#endif
