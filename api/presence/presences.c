#include "api/presence/presences.h"

#include "base/mem.h"
#include "store/followers.h"
#include "system/clock.h"

#include <stdlib.h>
#include <string.h>

enum { BUCKETS = 256 };

/* One present client of a mesh. */
typedef struct present {
    api_presence presence;
    char holder[ST_HOLDER + 1]; /* `holder` is the name of the client's token; "": none */
    uint64_t put;               /* time (st_clock_micros) at which the presence was last put */
    uint64_t moment;            /* moment at which the presence changed last */
    struct present *next;       /* the next present client in the order of ids */
} present;

/* The text of an event `presence`, which is written once for all listeners that have seen the same.
 * The last user frees it. */
typedef struct told {
    size_t users;
    uint64_t since, moment; /* it tells what changed after `since`, up to `moment` */
    api_text text;
} told;

/* A mesh with present clients. It stays in the table after the last client has left until its
 * listeners may be woken again. */
typedef struct place {
    uint64_t incarnation;
    char id[ST_MESH_ID + 1];
    uint64_t moment; /* moment of the last change: a presence came, changed or went */
    uint64_t woken;  /* time at which the listeners were last woken */
    bool due;        /* true if something changed since then */
    size_t count;
    present *first;
    told *told;         /* the newest event that was written; NULL: none */
    struct place *next; /* the next mesh in the bucket */
} place;

struct api_presences {
    st_store *store;
    pthread_mutex_t lock;
    pthread_cond_t changed; /* signalled when work may be due earlier than it was, and at the end */
    bool stopping;
    uint64_t moment; /* number of changes so far, which numbers the moments */
    uint64_t next;   /* time for which the thread of api_presences_run waits */
    size_t clients;
    place *buckets[BUCKETS];
};

enum { PRESENCE_MICROS = API_PRESENCE_SECONDS * 1000000 };

/* Gives back an event; NULL: nothing. Needs the lock, if there is another user. */
static void drop_told(told *event)
{
    if (event != NULL && --event->users == 0) {
        api_text_clear(&event->text);
        he_mem_free(event);
    }
}

api_presences *api_presences_new(st_store *store)
{
    api_presences *p = he_mem_zero(1, sizeof *p);
    if (p != NULL) {
        p->store = store;
        p->next = UINT64_MAX;
        pthread_mutex_init(&p->lock, NULL);
        st_clock_condition(&p->changed);
    }
    return p;
}

void api_presences_free(api_presences *p)
{
    if (p == NULL) {
        return;
    }
    for (size_t i = 0; i < BUCKETS; i++) {
        while (p->buckets[i] != NULL) {
            place *mesh = p->buckets[i];
            p->buckets[i] = mesh->next;
            while (mesh->first != NULL) {
                present *client = mesh->first;
                mesh->first = client->next;
                he_mem_free(client);
            }
            drop_told(mesh->told);
            he_mem_free(mesh);
        }
    }
    pthread_cond_destroy(&p->changed);
    pthread_mutex_destroy(&p->lock);
    he_mem_free(p);
}

/* --- functions that need the lock --- */

static place **bucket_of(api_presences *p, uint64_t incarnation)
{
    return &p->buckets[incarnation % BUCKETS];
}

static place *find(api_presences *p, uint64_t incarnation)
{
    place *mesh = *bucket_of(p, incarnation);
    while (mesh != NULL && mesh->incarnation != incarnation) {
        mesh = mesh->next;
    }
    return mesh;
}

static place *find_or_add(api_presences *p, const st_mesh_info *info)
{
    place *mesh = find(p, info->incarnation);
    if (mesh == NULL) {
        mesh = he_mem_zero(1, sizeof *mesh);
    } else {
        return mesh;
    }
    if (mesh != NULL) {
        place **bucket = bucket_of(p, info->incarnation);
        mesh->incarnation = info->incarnation;
        st_copy_text(mesh->id, info->id, ST_MESH_ID);
        mesh->next = *bucket;
        *bucket = mesh;
    }
    return mesh;
}

/* Removes a mesh from the table if no client was ever put there. */
static void drop_unused(api_presences *p, place *mesh)
{
    place **at = bucket_of(p, mesh->incarnation);
    if (mesh->moment != 0) {
        return;
    }
    while (*at != mesh) {
        at = &(*at)->next;
    }
    *at = mesh->next;
    he_mem_free(mesh);
}

/* Returns the place in the list of a mesh's clients where the client `id` is or belongs. */
static present **place_of(place *mesh, const char *id)
{
    present **at = &mesh->first;
    while (*at != NULL && strcmp((*at)->presence.client, id) < 0) {
        at = &(*at)->next;
    }
    return at;
}

static bool is_client(const present *client, const char *id)
{
    return client != NULL && strcmp(client->presence.client, id) == 0;
}

/* Notes that a presence of the mesh has changed. Returns true if the listeners of the mesh are to
 * be woken now; otherwise they are woken later, by api_presences_work. */
static bool note(api_presences *p, place *mesh, uint64_t now)
{
    mesh->moment = ++p->moment;
    mesh->due = mesh->woken != 0 && now - mesh->woken < API_PRESENCE_MICROS;
    if (!mesh->due) {
        mesh->woken = now;
        return true;
    }
    return false;
}

/* Lets the thread of api_presences_run wait no longer than until `time`. */
static void hurry(api_presences *p, uint64_t time)
{
    if (time < p->next) {
        p->next = time;
        pthread_cond_signal(&p->changed);
    }
}

static void drop(api_presences *p, place *mesh, present **at)
{
    present *client = *at;
    *at = client->next;
    mesh->count--;
    p->clients--;
    he_mem_free(client);
}

/* --- functions that take the lock --- */

/* Wakes the listeners of a mesh, if it is in memory; otherwise it has none. Needs no lock of the
 * table. */
static void wake(api_presences *p, const char *id, uint64_t incarnation)
{
    st_mesh *mesh = NULL;
    if (st_find(p->store, id, &mesh) == ST_OK) {
        st_follow_nudge(mesh, incarnation);
        st_release(mesh);
    }
}

/* Returns the number of clients of a mesh that have the token `holder`. */
static size_t count_of(const place *mesh, const char *holder)
{
    size_t count = 0;
    for (const present *client = mesh->first; client != NULL; client = client->next) {
        count += strcmp(client->holder, holder) == 0;
    }
    return count;
}

/* Makes a client of the token `holder` at its place in the list of a mesh. */
static api_presence_put add(api_presences *p, place *mesh, present **at, const char *holder)
{
    if (holder[0] != '\0' && count_of(mesh, holder) >= API_MAX_PRESENT_OF_TOKEN) {
        return API_PRESENCE_FULL_OF_TOKEN;
    }
    if (mesh->count >= API_MAX_PRESENT_OF_MESH || p->clients >= API_MAX_PRESENT) {
        return API_PRESENCE_FULL;
    }
    present *client = he_mem_zero(1, sizeof *client);
    if (client == NULL) {
        return API_PRESENCE_NO_MEMORY;
    }
    client->next = *at;
    *at = client;
    mesh->count++;
    p->clients++;
    return API_PRESENCE_PUT;
}

/* Does the work of api_presences_put with the lock held. `wakes` becomes true if the listeners of
 * the mesh must be woken. */
static api_presence_put put(api_presences *p, const st_mesh_info *info, const char *holder,
                            const api_presence *presence, bool *wakes)
{
    const uint64_t now = st_clock_micros();
    place *mesh = find_or_add(p, info);
    if (mesh == NULL) {
        return API_PRESENCE_NO_MEMORY;
    }
    present **at = place_of(mesh, presence->client);
    const bool is_new = !is_client(*at, presence->client);
    api_presence_put result = API_PRESENCE_PUT;
    if (is_new) {
        result = add(p, mesh, at, holder);
    } else if (strcmp((*at)->holder, holder) != 0) {
        result = API_PRESENCE_TAKEN;
    }
    if (result != API_PRESENCE_PUT) {
        drop_unused(p, mesh);
        return result;
    }
    present *client = *at;
    client->put = now;
    if (is_new || !api_presence_is_equal(&client->presence, presence)) {
        client->presence = *presence;
        st_copy_text(client->holder, holder, ST_HOLDER);
        *wakes = note(p, mesh, now);
        client->moment = mesh->moment;
    }
    hurry(p, mesh->due ? mesh->woken + API_PRESENCE_MICROS : now + PRESENCE_MICROS);
    return API_PRESENCE_PUT;
}

api_presence_put api_presences_put(api_presences *p, const st_mesh_info *info, const char *holder,
                                   const api_presence *presence)
{
    bool wakes = false;
    pthread_mutex_lock(&p->lock);
    const api_presence_put result = put(p, info, holder, presence, &wakes);
    pthread_mutex_unlock(&p->lock);
    if (wakes) {
        wake(p, info->id, info->incarnation);
    }
    return result;
}

void api_presences_leave(api_presences *p, const st_mesh_info *info, const char *holder,
                         const char *client)
{
    bool wakes = false;
    pthread_mutex_lock(&p->lock);
    place *mesh = find(p, info->incarnation);
    present **at = mesh == NULL ? NULL : place_of(mesh, client);
    if (at != NULL && is_client(*at, client) && strcmp((*at)->holder, holder) == 0) {
        drop(p, mesh, at);
        wakes = note(p, mesh, st_clock_micros());
        hurry(p, mesh->woken + API_PRESENCE_MICROS);
    }
    pthread_mutex_unlock(&p->lock);
    if (wakes) {
        wake(p, info->id, info->incarnation);
    }
}

size_t api_presences_count(api_presences *p)
{
    pthread_mutex_lock(&p->lock);
    const size_t count = p->clients;
    pthread_mutex_unlock(&p->lock);
    return count;
}

/* --- what is due later --- */

/* A mesh whose listeners must be woken. */
typedef struct due {
    char id[ST_MESH_ID + 1];
    uint64_t incarnation;
} due;

/* The most meshes whose listeners are woken before the lock is taken again. */
enum { DUE_AT_ONCE = 32 };

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* Forgets the clients of a mesh that were not put for too long. Returns the time at which the
 * next one will be forgotten. A client may have been put after `now`, while the lock was released
 * to wake listeners. */
static uint64_t forget(api_presences *p, place *mesh, uint64_t now)
{
    uint64_t next = UINT64_MAX;
    for (present **at = &mesh->first; *at != NULL;) {
        if (now >= (*at)->put + PRESENCE_MICROS) {
            drop(p, mesh, at);
            mesh->moment = ++p->moment;
            mesh->due = true;
        } else {
            next = earlier(next, (*at)->put + PRESENCE_MICROS);
            at = &(*at)->next;
        }
    }
    return next;
}

/* Does what is due for one mesh. Returns the time at which something will be due for it. `wakes`
 * becomes true if its listeners must be woken; not if they may not be woken yet. */
static uint64_t work_on(api_presences *p, place *mesh, uint64_t now, bool *wakes)
{
    const uint64_t next = forget(p, mesh, now);
    const uint64_t may_wake = mesh->woken + API_PRESENCE_MICROS;
    *wakes = mesh->due && now >= may_wake;
    if (*wakes) {
        mesh->due = false;
        mesh->woken = now;
        return earlier(next, now + API_PRESENCE_MICROS);
    }
    return mesh->due || mesh->count == 0 ? earlier(next, may_wake) : next;
}

/* Does what is due for the meshes of a bucket, until `list` is full. */
static uint64_t work_in(api_presences *p, place **bucket, uint64_t now, due list[DUE_AT_ONCE],
                        size_t *count)
{
    uint64_t next = UINT64_MAX;
    for (place **at = bucket; *at != NULL;) {
        place *mesh = *at;
        bool wakes = false;
        if (*count == DUE_AT_ONCE) {
            return now;
        }
        const uint64_t then = work_on(p, mesh, now, &wakes);
        if (wakes) {
            list[*count].incarnation = mesh->incarnation;
            memcpy(list[(*count)++].id, mesh->id, sizeof mesh->id);
        }
        if (mesh->count == 0 && !mesh->due && !wakes && now >= mesh->woken + API_PRESENCE_MICROS) {
            *at = mesh->next;
            drop_told(mesh->told);
            he_mem_free(mesh);
        } else {
            next = earlier(next, then);
            at = &mesh->next;
        }
    }
    return next;
}

/* Does what is due, with the lock held but while listeners are woken. Returns the time at which
 * something will be due. */
static uint64_t work(api_presences *p, uint64_t now)
{
    uint64_t next = UINT64_MAX;
    for (size_t i = 0; i < BUCKETS;) {
        due list[DUE_AT_ONCE];
        size_t count = 0;
        const uint64_t then = work_in(p, &p->buckets[i], now, list, &count);
        if (count > 0) {
            pthread_mutex_unlock(&p->lock);
            for (size_t k = 0; k < count; k++) {
                wake(p, list[k].id, list[k].incarnation);
            }
            pthread_mutex_lock(&p->lock);
        }
        if (then > now) {
            next = earlier(next, then);
            i++;
        }
    }
    return next;
}

uint64_t api_presences_work(api_presences *p, uint64_t now)
{
    pthread_mutex_lock(&p->lock);
    const uint64_t next = work(p, now);
    pthread_mutex_unlock(&p->lock);
    return next;
}

void api_presences_run(api_presences *p)
{
    pthread_mutex_lock(&p->lock);
    while (!p->stopping) {
        const uint64_t now = st_clock_micros();
        if (p->next == UINT64_MAX) {
            pthread_cond_wait(&p->changed, &p->lock);
        } else if (now < p->next) {
            (void)st_clock_wait(&p->changed, &p->lock, p->next);
        } else {
            /* A change during the work, while the lock is released, sets `next` to an earlier
             * time. */
            p->next = UINT64_MAX;
            p->next = earlier(work(p, now), p->next);
        }
    }
    pthread_mutex_unlock(&p->lock);
}

void api_presences_stop(api_presences *p)
{
    pthread_mutex_lock(&p->lock);
    p->stopping = true;
    pthread_cond_signal(&p->changed);
    pthread_mutex_unlock(&p->lock);
}

/* --- writing --- */

/* The present clients of a mesh, of which those are written that changed after `since`. */
typedef struct shown {
    const place *mesh; /* NULL: the mesh has no present clients */
    uint64_t since;
} shown;

static const present *first_of(const shown *s)
{
    return s->mesh == NULL ? NULL : s->mesh->first;
}

static void write_ids(api_out *out, const void *value)
{
    api_out_array_begin(out);
    for (const present *client = first_of(value); client != NULL; client = client->next) {
        api_out_string(out, client->presence.client);
    }
    api_out_array_end(out);
}

static void write_presences(api_out *out, const void *value)
{
    const shown *s = value;
    api_out_array_begin(out);
    for (const present *client = first_of(s); client != NULL; client = client->next) {
        if (client->moment > s->since) {
            api_record_write(out, &api_presence_record, &client->presence);
        }
    }
    api_out_array_end(out);
}

static const api_field presences_fields[] = {
    API_FIELD_MADE("clients", "*#presence", write_presences, .required = true,
                   .doc = "The present clients, in the order of their ids."),
};
const api_record api_presences_record = API_RECORD("presences", presences_fields);

static const api_field news_fields[] = {
    API_FIELD_MADE("clients", "*text", write_ids, .required = true,
                   .doc = "The ids of all present clients; others have left."),
    API_FIELD_MADE("changed", "*#presence", write_presences, .required = true,
                   .doc = "The clients that are new, or show something else than before."),
};
const api_record api_presence_news_record = API_RECORD("presence_news", news_fields);

void api_presences_write(api_presences *p, uint64_t incarnation, api_out *out)
{
    pthread_mutex_lock(&p->lock);
    const shown s = {.mesh = find(p, incarnation)};
    api_record_write(out, &api_presences_record, &s);
    pthread_mutex_unlock(&p->lock);
}

static void write_news(const place *mesh, uint64_t since, api_text *text)
{
    api_out out;
    const shown s = {.mesh = mesh, .since = since};
    api_text_add_string(text, "event: presence\ndata: ");
    api_out_init(&out, text);
    api_record_write(&out, &api_presence_news_record, &s);
    api_text_add_string(text, "\n\n");
}

/* Returns the event for listeners that have seen the presences up to `since`; the caller gives it
 * back. Returns NULL when memory is out. Needs the lock. */
static told *tell(place *mesh, uint64_t since)
{
    told *event = mesh->told;
    if (event != NULL && event->moment == mesh->moment && event->since == since) {
        event->users++;
        return event;
    }
    event = he_mem_zero(1, sizeof *event);
    if (event == NULL) {
        return NULL;
    }
    *event = (told){.users = 1, .since = since, .moment = mesh->moment};
    write_news(mesh, since, &event->text);
    if (event->text.failed) {
        drop_told(event);
        return NULL;
    }
    /* A listener that begins, or is slow, does not replace the event that most listeners need. */
    if (mesh->told == NULL || mesh->told->moment < mesh->moment || mesh->told->since < since) {
        drop_told(mesh->told);
        mesh->told = event;
        event->users++;
    }
    return event;
}

void api_presences_news(api_presences *p, uint64_t incarnation, uint64_t *seen, api_text *text)
{
    told *event = NULL;
    pthread_mutex_lock(&p->lock);
    place *mesh = find(p, incarnation);
    const bool nobody = mesh == NULL || mesh->count == 0;
    const uint64_t moment = nobody ? 0 : mesh->moment;
    if (moment != *seen) {
        event = nobody ? NULL : tell(mesh, *seen);
        if (event == NULL) {
            write_news(mesh, *seen, text);
        }
        *seen = moment;
    }
    pthread_mutex_unlock(&p->lock);
    if (event != NULL) {
        api_text_add(text, event->text.bytes, event->text.length);
        pthread_mutex_lock(&p->lock);
        drop_told(event);
        pthread_mutex_unlock(&p->lock);
    }
}
