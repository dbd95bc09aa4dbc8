/* config_option.h - one row of THE table of options, for the files that read and print it. */
#ifndef HE_SERVER_CONFIG_OPTION_H
#define HE_SERVER_CONFIG_OPTION_H

#include "api/json/text.h"
#include "server/config.h"

#include <stddef.h>

/* An action and a command are not settings: they have no variable, and no line in a file. A command
 * takes a text. A source is where settings are read from: it has a variable, and no line. */
typedef enum srv_option_kind {
    SRV_TEXT,
    SRV_LIST,
    SRV_BYTES,
    SRV_COUNT,
    SRV_FLAG,
    SRV_CHOICE,
    SRV_ACTION,
    SRV_COMMAND,
    SRV_SOURCE
} srv_option_kind;

typedef struct srv_option {
    const char *name; /* --name; NAME with '_' after HEDGE_ is its variable */
    srv_option_kind kind;
    size_t member;
    const char *fallback; /* as it would be written */
    const char *argument; /* for --help */
    uint64_t low, high;
    const char *doc;
} srv_option;

enum { SRV_VARIABLE_TEXT = 64, SRV_MOST_OPTIONS = 96 };

extern const srv_option srv_options[];
extern const size_t srv_option_count;

const srv_option *srv_option_find(const char *name, size_t length);
void srv_option_variable(const srv_option *row, char out[SRV_VARIABLE_TEXT]);
/* Settings may stand in a file. */
bool srv_option_is_setting(const srv_option *row);
/* It may stand alone: "--samples". */
bool srv_option_is_switch(const srv_option *row);

/* Which of the words of an SRV_CHOICE the text is, from 0; false where it is none. */
bool srv_option_choice(const srv_option *row, const char *text, uint64_t *out);
/* The value of a setting or a source, as a configuration would set it, added to `out`. */
void srv_option_write(const srv_option *row, const srv_config *config, api_text *out);

/* Give an option its value. `source` is what the user wrote, "--listen", "HEDGE_LISTEN" or
 * "hedged.conf:3: listen"; it begins the sentence in `message` when the value is refused. Of one
 * place the items of lists add up; `seen`, an entry for each row, false at first, knows which
 * lists the place has begun, and those replace what came from places of less weight. */
bool srv_option_set(srv_config *config, const srv_option *row, const char *text, const char *source,
                    bool *seen, char *message, size_t size);

#endif
