#include "server/boot/present.h"

#include "api/presence/presences.h"

static void *run(void *context)
{
    const srv_parts *parts = context;
    st_store_serve(parts->store);
    api_presences_run(api_service_presences(parts->service));
    return NULL;
}

bool srv_present_open(srv_parts *parts)
{
    parts->has_present = pthread_create(&parts->present, NULL, run, parts) == 0;
    return parts->has_present || srv_open_failed(parts, "there are not enough threads to start");
}

void srv_present_close(srv_parts *parts)
{
    if (parts->has_present) {
        api_presences_stop(api_service_presences(parts->service));
        pthread_join(parts->present, NULL);
        parts->has_present = false;
    }
}
