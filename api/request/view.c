#include "api/request/view.h"

bool api_view_begin(api_exchange *x, api_view *view)
{
    *view = (api_view){0};
    if (x->phase != API_PHASE_BODY) {
        view->snapshot = api_snapshot_of(x, &view->mesh);
        return view->snapshot != NULL;
    }
    view->mesh = api_read_begin(x);
    return view->mesh != NULL;
}

void api_view_end(api_exchange *x, api_view *view)
{
    if (view->snapshot != NULL) {
        st_snapshot_release(view->snapshot);
    } else {
        api_read_end(x);
    }
    *view = (api_view){0};
}
