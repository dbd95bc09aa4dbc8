#include "server/maintenance.h"

#include "journal/sqlite/sqlite_backup.h"

#include <inttypes.h>

bool srv_maintenance_asked(const srv_config *config)
{
    return config->backup != NULL || config->restore != NULL;
}

static int fail(const char *why)
{
    fprintf(stderr, "hedged: %s\n", why);
    return 1;
}

static int backup(const char *folder, const char *file)
{
    char message[ST_SQLITE_MESSAGE];
    st_sqlite_opened out;
    if (!st_sqlite_backup(folder, file, message)) {
        return fail(message);
    }
    if (!st_sqlite_look(file, &out)) {
        return fail(out.message);
    }
    printf("%s holds %" PRIu64 " meshes of %s\n", file, out.journal.count(out.journal.self),
           folder);
    out.journal.close(out.journal.self);
    return 0;
}

static int restore(const char *folder, const char *file)
{
    char message[ST_SQLITE_MESSAGE], before[ST_SQLITE_MESSAGE];
    if (!st_sqlite_restore(folder, file, before, message)) {
        return fail(message);
    }
    printf("%s is restored from %s; what was there before is in %s\n", folder, file, before);
    return 0;
}

int srv_maintenance_run(const srv_config *config)
{
    const char *folder = srv_config_folder(config);
    if (folder == NULL) {
        return fail("a store in memory has nothing to work on: name one by --store sqlite:DIR");
    }
    return config->backup != NULL ? backup(folder, config->backup)
                                  : restore(folder, config->restore);
}
