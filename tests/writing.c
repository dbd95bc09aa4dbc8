#include "tests/writing.h"

he_mesh *writing_begin(st_mesh *mesh, st_write *write)
{
    return st_write_begin(mesh, NULL, write) == ST_OK ? write->content : NULL;
}

bool writing_commit(st_write *write, const char *ops, st_mesh_info *info)
{
    if (st_write_changes(write, NULL) != HE_OK) {
        st_write_abort(write);
        return false;
    }
    bool committed = st_write_commit(write, ops) == ST_OK;
    if (info != NULL) {
        *info = write->info;
    }
    return committed;
}

st_status writing_step(st_mesh *mesh, st_action which, uint32_t steps)
{
    st_write write;
    st_status status = st_write_begin(mesh, NULL, &write);
    if (status != ST_OK) {
        return status;
    }
    status = st_write_step(&write, which, steps);
    if (status == ST_OK) {
        return st_write_commit(&write, NULL);
    }
    st_write_abort(&write);
    return status;
}

st_status writing_replace(st_mesh *mesh, he_mesh *takes, const char *name, st_mesh_info *info)
{
    st_write write;
    st_status status = st_write_begin(mesh, NULL, &write);
    if (status == ST_OK) {
        st_write_replace(&write, takes, NULL);
        if (name != NULL) {
            st_write_rename(&write, name);
        }
        status = st_write_commit(&write, NULL);
        if (info != NULL) {
            *info = write.info;
        }
    }
    return status;
}

st_status writing_remove(st_mesh *mesh)
{
    st_write write;
    st_status status = st_write_begin(mesh, NULL, &write);
    if (status == ST_OK) {
        st_write_remove(&write);
        status = st_write_commit(&write, NULL);
    }
    return status;
}
