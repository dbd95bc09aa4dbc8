/* config_option.h - the table of options: its rows, and functions for the files that read and print
 * the options. */
#ifndef HE_SERVER_CONFIG_OPTION_H
#define HE_SERVER_CONFIG_OPTION_H

#include "api/json/text.h"
#include "server/config.h"

#include <stddef.h>

/* The kinds of options. SRV_ACTION and SRV_COMMAND are what hedged does instead of serving; only
 * SRV_COMMAND takes a text. SRV_SOURCE is the path of the configuration file; it has an environment
 * variable, but cannot be in that file. All other kinds are settings, which have a variable and may
 * be in the file. */
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
    /* The flag without its dashes; the variable is HEDGE_ and the name in capitals with '_'. */
    const char *name;
    srv_option_kind kind;
    size_t member;
    const char *fallback; /* the option's default, as a user would write it */
    const char *argument; /* placeholder in --help */
    uint64_t low, high;
    const char *doc;
} srv_option;

enum { SRV_VARIABLE_TEXT = 64, SRV_MOST_OPTIONS = 96 };

extern const srv_option srv_options[];
extern const size_t srv_option_count;

const srv_option *srv_option_find(const char *name, size_t length);
void srv_option_variable(const srv_option *row, char out[SRV_VARIABLE_TEXT]);
/* Returns true if the option may stand in a configuration file. */
bool srv_option_is_setting(const srv_option *row);
/* Returns true if the option can be given without a value, as in "--samples". */
bool srv_option_is_switch(const srv_option *row);

/* Finds a word among the words that an option of the kind SRV_CHOICE allows, and sets `out` to its
 * index. Returns false if it is none of them. */
bool srv_option_choice(const srv_option *row, const char *text, uint64_t *out);
/* Appends the value of a setting or a source to `out`, as a configuration file would have it. */
void srv_option_write(const srv_option *row, const srv_config *config, api_text *out);

/* The value that one source of settings, such as a flag, gives an option. */
typedef struct srv_option_value {
    const srv_option *row;
    const char *text;
    /* What the user wrote: "--listen", "HEDGE_LISTEN" or "hedged.conf:3: listen". It begins the
     * sentence that refuses the value. */
    const char *source;
} srv_option_value;

/* Sets an option. Returns false with a sentence in `message` if the value is refused. Items that
 * one source (the file, the environment or the flags) gives for a list add up, and replace those of
 * sources that it overrides. So `seen` has an entry for each option, which says whether the source
 * that is being read has set this option already; all entries are false when a source begins. */
bool srv_option_set(srv_config *config, const srv_option_value *given, bool *seen, char *message,
                    size_t size);

#endif
