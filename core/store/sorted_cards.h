/* sorted_cards.h - the cards (short descriptions) of all meshes of a store whose journal stores
 * nothing, in each order in which meshes can be listed (st_card_order). A journal that stores
 * meshes lists them by the indexes of its database instead.
 *
 * The cards form a skip list for each order. An entry has the same height in all of them, drawn by
 * lot, so that a quarter of the entries of a level are also on the next level:
 *
 *     level 2   first -----------------------> e -----------------------> NULL
 *     level 1   first --------> b -----------> e -----------> g --------> NULL
 *     level 0   first --> a --> b --> c --> d --> e --> f --> g --> h --> NULL
 *
 * Finding a place, and putting a card there, takes time proportional to the logarithm of the number
 * of meshes. Memory is needed only when a mesh is created (st_sorted_entry_new), so a change of a
 * mesh cannot fail here.
 *
 * The lock is taken after all other locks of the store. */
#ifndef HE_STORE_SORTED_CARDS_H
#define HE_STORE_SORTED_CARDS_H

#include "journal/record.h"

#include <pthread.h>

enum { ST_SORTED_LEVELS = 12 };

/* One mesh in the lists. */
typedef struct st_sorted_entry st_sorted_entry;

typedef struct st_sorted {
    pthread_mutex_t lock;
    st_sorted_entry *first[ST_SORTED_LEVELS][ST_CARD_ORDERS];
} st_sorted;

void st_sorted_init(st_sorted *sorted);
/* Destroys the lists; their entries belong to the meshes and are not freed. */
void st_sorted_clear(st_sorted *sorted);

/* Makes an entry that is in no list yet. Returns NULL if memory is out. */
st_sorted_entry *st_sorted_entry_new(void);
void st_sorted_entry_free(st_sorted_entry *entry); /* takes NULL */

/* Puts an entry into its place in each list, or moves it there, so that it is listed by `card`. */
void st_sorted_put(st_sorted *sorted, st_sorted_entry *entry, const st_card *card);
/* Removes an entry from each list; does nothing if it is in none. */
void st_sorted_remove(st_sorted *sorted, st_sorted_entry *entry);
/* Copies the cards of a page to `out`. Returns how many there are. */
size_t st_sorted_list(st_sorted *sorted, const st_card_page *page, st_card *out);

#endif
