#include "store/sorted_cards.h"

#include "base/mem.h"
#include "system/lock.h"
#include "system/random.h"

struct st_sorted_entry {
    st_card card;
    bool listed;
    size_t height; /* the entry is on the levels below this one */
    /* for each of these levels and each order, the next entry on the level; NULL: it is the last */
    st_sorted_entry *next[][ST_CARD_ORDERS];
};

void st_sorted_init(st_sorted *sorted)
{
    *sorted = (st_sorted){.first = {{NULL}}};
    pthread_mutex_init(&sorted->lock, NULL);
}

void st_sorted_clear(st_sorted *sorted)
{
    pthread_mutex_destroy(&sorted->lock);
}

/* Draws the height of an entry. The numbers are unguessable, so no client can choose names that
 * make the lists slow. */
static size_t draw_height(void)
{
    size_t height = 1;
    for (uint64_t bits = st_random(); height < ST_SORTED_LEVELS && bits % 4 == 0; bits /= 4) {
        height++;
    }
    return height;
}

st_sorted_entry *st_sorted_entry_new(void)
{
    const size_t height = draw_height();
    st_sorted_entry *entry = NULL;
    entry = he_mem_zero(1, sizeof *entry + height * sizeof *entry->next);
    if (entry != NULL) {
        entry->height = height;
    }
    return entry;
}

void st_sorted_entry_free(st_sorted_entry *entry)
{
    he_mem_free(entry);
}

/* Returns the link from an entry, or from the beginning of the list if the entry is NULL, to the
 * next entry of a level. */
static st_sorted_entry **link_of(st_sorted *sorted, st_sorted_entry *entry, size_t level,
                                 st_card_order order)
{
    return entry == NULL ? &sorted->first[level][order] : &entry->next[level][order];
}

/* Finds, on each level, the last entry whose place is before that of the card; NULL: the place is
 * at the beginning. */
static void find_place(st_sorted *sorted, st_card_order order, const st_card *card,
                       st_sorted_entry *before[ST_SORTED_LEVELS])
{
    st_sorted_entry *at = NULL;
    for (size_t level = ST_SORTED_LEVELS; level-- > 0;) {
        st_sorted_entry *next = *link_of(sorted, at, level, order);
        while (next != NULL && st_card_compare(order, &next->card, card) < 0) {
            at = next;
            next = *link_of(sorted, at, level, order);
        }
        before[level] = at;
    }
}

static void take_out(st_sorted *sorted, st_sorted_entry *entry)
{
    st_sorted_entry *before[ST_SORTED_LEVELS];
    for (int order = 0; order < ST_CARD_ORDERS && entry->listed; order++) {
        find_place(sorted, (st_card_order)order, &entry->card, before);
        for (size_t level = 0; level < entry->height; level++) {
            *link_of(sorted, before[level], level, (st_card_order)order) =
                entry->next[level][order];
        }
    }
    entry->listed = false;
}

void st_sorted_put(st_sorted *sorted, st_sorted_entry *entry, const st_card *card)
{
    st_sorted_entry *before[ST_SORTED_LEVELS];
    st_lock_mutex(&sorted->lock);
    take_out(sorted, entry);
    entry->card = *card;
    for (int order = 0; order < ST_CARD_ORDERS; order++) {
        find_place(sorted, (st_card_order)order, card, before);
        for (size_t level = 0; level < entry->height; level++) {
            st_sorted_entry **link = link_of(sorted, before[level], level, (st_card_order)order);
            entry->next[level][order] = *link;
            *link = entry;
        }
    }
    entry->listed = true;
    pthread_mutex_unlock(&sorted->lock);
}

void st_sorted_remove(st_sorted *sorted, st_sorted_entry *entry)
{
    st_lock_mutex(&sorted->lock);
    take_out(sorted, entry);
    pthread_mutex_unlock(&sorted->lock);
}

size_t st_sorted_list(st_sorted *sorted, const st_card_page *page, st_card *out)
{
    const st_card_order order = page->order;
    st_sorted_entry *before[ST_SORTED_LEVELS] = {NULL};
    size_t count = 0;
    st_lock_mutex(&sorted->lock);
    if (page->after != NULL) {
        find_place(sorted, order, page->after, before);
    }
    st_sorted_entry *at = *link_of(sorted, before[0], 0, order);
    if (at != NULL && page->after != NULL && st_card_compare(order, &at->card, page->after) == 0) {
        at = at->next[0][order];
    }
    for (; at != NULL && count < page->limit; at = at->next[0][order]) {
        out[count++] = at->card;
    }
    pthread_mutex_unlock(&sorted->lock);
    return count;
}
