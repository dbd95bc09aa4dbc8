#include "api/read/first_cards.h"

#include "base/mem.h"

static bool is_before(const api_first_cards *first, size_t a, size_t b)
{
    return st_card_compare(first->page.order, &first->cards[a], &first->cards[b]) < 0;
}

static void exchange(api_first_cards *first, size_t a, size_t b)
{
    const st_card card = first->cards[a];
    first->cards[a] = first->cards[b];
    first->cards[b] = card;
}

/* Restores the order of a heap of `count` cards of which only the top may be wrong. */
static void sift_down(api_first_cards *first, size_t count)
{
    for (size_t at = 0, child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && is_before(first, child, child + 1)) {
            child++;
        }
        if (!is_before(first, at, child)) {
            return;
        }
        exchange(first, at, child);
    }
}

static void sift_up(api_first_cards *first)
{
    for (size_t at = first->count - 1; at > 0 && is_before(first, (at - 1) / 2, at);
         at = (at - 1) / 2) {
        exchange(first, (at - 1) / 2, at);
    }
}

static bool reserve(api_first_cards *first)
{
    if (first->count < first->capacity) {
        return true;
    }
    const size_t capacity = he_mem_grown(first->capacity, first->count + 1);
    st_card *cards = he_mem_array(first->cards, capacity, sizeof *cards);
    if (cards == NULL) {
        return false;
    }
    first->cards = cards;
    first->capacity = capacity;
    return true;
}

bool api_first_cards_add(api_first_cards *first, const st_card *card)
{
    const st_card_page *page = &first->page;
    if (page->after != NULL && st_card_compare(page->order, card, page->after) <= 0) {
        return true;
    }
    if (first->count < page->limit) {
        if (!reserve(first)) {
            return false;
        }
        first->cards[first->count++] = *card;
        sift_up(first);
    } else if (st_card_compare(page->order, card, &first->cards[0]) < 0) {
        first->cards[0] = *card;
        sift_down(first, first->count);
    }
    return true;
}

void api_first_cards_sort(api_first_cards *first)
{
    for (size_t count = first->count; count > 1; count--) {
        exchange(first, 0, count - 1);
        sift_down(first, count - 1);
    }
}

void api_first_cards_clear(api_first_cards *first)
{
    he_mem_free(first->cards);
    *first = (api_first_cards){.count = 0};
}
