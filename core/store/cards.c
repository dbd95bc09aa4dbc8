/* cards.c - lists the cards (short descriptions) of all meshes, in memory or not. */
#include "store/table.h"

#include <string.h>

/* The meshes in memory are listed in batches of BATCH meshes, so that references to few meshes are
 * taken at a time. */
enum { BATCH = 64 };

/* Copies the card (short description) of a mesh that is in memory. Returns false if the mesh was
 * removed. */
static bool card_of(st_mesh *mesh, st_card *out)
{
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    *out = (st_card){
        .incarnation = info.incarnation,
        .metadata = info.metadata,
        .revision = info.revision,
        .record = info.record,
        .created = info.created,
        .modified = info.modified,
        .counts = st_counts_of(content),
        .bytes = he_mesh_bytes(content),
    };
    memcpy(out->id, info.id, sizeof out->id);
    memcpy(out->name, info.name, sizeof out->name);
    if (info.unreadable == ST_DAMAGED) {
        memcpy(out->damage, st_damage(mesh), sizeof out->damage);
    }
    st_read_end(mesh);
    return !info.removed;
}

static size_t cards_in_memory(st_store *store, const char *after, st_card *out, size_t limit)
{
    st_mesh *batch[BATCH];
    char last[ST_MESH_ID + 1];
    size_t count = 0, held = 1;
    memcpy(last, after, strlen(after) + 1);
    while (count < limit && held > 0) {
        held = st_list(store, last, batch, limit - count < BATCH ? limit - count : BATCH);
        for (size_t i = 0; i < held; i++) {
            memcpy(last, batch[i]->info.id, sizeof last);
            count += card_of(batch[i], &out[count]) ? 1 : 0;
            st_release(batch[i]);
        }
    }
    return count;
}

/* Chooses between two cards (short descriptions of meshes) with one id, one from memory and one
 * from the disk. If they describe one mesh, the card on the disk is chosen if it counts more
 * records or if the card from memory states damage. If they describe different meshes, the mesh of
 * the card on the disk was removed, but the removal is not on the disk yet; so the card from memory
 * is chosen. */
static const st_card *newer(const st_card *memory, const st_card *disk)
{
    bool same = memory->incarnation == disk->incarnation;
    bool ahead = disk->record > memory->record || memory->damage[0] != '\0';
    return same && ahead ? disk : memory;
}

/* A part of an array of cards (short descriptions of meshes), sorted by id. */
typedef struct card_run {
    const st_card *at, *end;
} card_run;

static size_t merge(card_run memory, card_run disk, st_card *out, size_t limit)
{
    size_t count = 0;
    while (count < limit && (memory.at < memory.end || disk.at < disk.end)) {
        int order = memory.at == memory.end ? 1
                    : disk.at == disk.end   ? -1
                                            : strcmp(memory.at->id, disk.at->id);
        out[count++] = order < 0 ? *memory.at : order > 0 ? *disk.at : *newer(memory.at, disk.at);
        memory.at += order <= 0 ? 1 : 0;
        disk.at += order >= 0 ? 1 : 0;
    }
    return count;
}

/* Lists the cards (short descriptions) of all meshes. The meshes in memory are listed first, then
 * those on the disk: so a mesh that is removed from memory in between is listed twice rather than
 * not at all. */
st_status st_cards(st_store *store, const char *after, st_card *out, size_t limit, size_t *count)
{
    const st_journal *journal = &store->journal;
    if (!journal->keeps) {
        *count = cards_in_memory(store, after, out, limit);
        return ST_OK;
    }
    st_card *cards = he_mem_array(NULL, 2 * limit, sizeof *cards);
    if (cards == NULL) {
        return ST_NO_MEMORY;
    }
    size_t on_disk = 0, in_memory = cards_in_memory(store, after, cards, limit);
    st_status status = journal->list(journal->self, after, cards + limit, limit, &on_disk);
    if (status == ST_OK) {
        *count = merge((card_run){cards, cards + in_memory},
                       (card_run){cards + limit, cards + limit + on_disk}, out, limit);
    }
    he_mem_free(cards);
    return status;
}

st_status st_cards_by(st_store *store, const st_card_page *page, st_card *out, size_t *count)
{
    const st_journal *journal = &store->journal;
    if (journal->keeps) {
        return journal->list_by(journal->self, page, out, count);
    }
    *count = st_sorted_list(&store->sorted, page, out);
    return ST_OK;
}
