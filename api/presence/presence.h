/* presence.h - what a client shows of itself to the other clients of a mesh: its name, what it has
 * selected, and where it looks from. */
#ifndef HE_API_PRESENCE_PRESENCE_H
#define HE_API_PRESENCE_PRESENCE_H

#include "api/json/json_in.h"
#include "api/json/record.h"
#include "api/limits.h"

typedef struct api_presence {
    char client[API_PRESENCE_CLIENT + 1]; /* the id that the client chose for itself */
    char name[API_PRESENCE_NAME + 1];     /* UTF-8; "": the client has no name */
    bool has_selection, has_camera;
    struct {
        he_kind kind; /* kind of the selected elements, up to HE_FACE */
        uint32_t ids[API_PRESENCE_IDS];
        uint32_t listed; /* how many ids there are in `ids` */
        uint64_t count;  /* how many elements are selected, at least `listed` */
    } selection;
    struct {
        he_vec3 position, target, up;
    } camera;
} api_presence;

/* Reads the body of PUT .../presence. `leaves` becomes true if the client says that it leaves.
 * Returns false with the problem of the cursor filled if the document is not a presence. */
bool api_presence_read(const api_in *root, api_presence *out, bool *leaves);
/* Returns true if the two presences show the same. */
bool api_presence_is_equal(const api_presence *a, const api_presence *b);

/* The JSON members of a presence, of its selection and of its camera. */
extern const api_record api_presence_record, api_presence_selection_record,
    api_presence_camera_record;

#endif
