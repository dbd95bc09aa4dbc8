/* Tests of the daemon's options: a flag overrides an environment variable, and an environment
 * variable overrides the default. Each refusal must be a sentence. */
#include "tests/unit/fixture.h"

#include "server/config.h"
#include "server/net/address.h"

#include <unistd.h>

static const char *const *variables; /* environment variables of the test: name, value, name, value,
                                        and so on, then NULL */

static char *environment(const char *name)
{
    for (size_t i = 0; variables != NULL && variables[i] != NULL; i += 2) {
        if (strcmp(variables[i], name) == 0) {
            return (char *)(uintptr_t)variables[i + 1];
        }
    }
    return NULL;
}

static char message[320];

static bool read_words(srv_config *config, const char *const *words)
{
    char *argv[16];
    int argc = 0;
    for (; words[argc] != NULL; argc++) {
        argv[argc] = (char *)(uintptr_t)words[argc];
    }
    message[0] = '\0';
    const srv_config_sources from = {argc, argv, environment};
    return srv_config_read(config, &from, message, sizeof message);
}

#define READ(config, ...) read_words(config, (const char *const[]){__VA_ARGS__, NULL})

static void options_that_are_not_given_have_defaults(void **state)
{
    (void)state;
    srv_config config;
    variables = NULL;
    assert_true(read_words(&config, (const char *const[]){NULL}));
    assert_string_equal(config.listen, "127.0.0.1:8080");
    assert_int_equal(config.undo_budget, 256 << 20);
    assert_int_equal(config.log, SRV_LOG_AUTO);
    assert_false(config.insecure);
    assert_int_equal(config.policy.hosts.count, 0);
    srv_config_clear(&config);
}

static void options_override_the_environment(void **state)
{
    (void)state;
    static const char *const set[] = {
        "HEDGE_MAX_MESHES", "7",   "HEDGE_LISTEN", "[::1]:1", "HEDGE_LOG", "off",
        "HEDGE_ALLOW_HOST", "a,b", "HEDGE_WEB",    "",        NULL};
    srv_config config;
    variables = set;
    assert_true(READ(&config, "--max-meshes", "9", "--undo-budget=3K", "--samples"));
    assert_int_equal(config.max_meshes, 9);
    assert_int_equal(config.undo_budget, 3072);
    assert_true(config.samples);
    assert_string_equal(config.listen, "[::1]:1");
    assert_int_equal(config.log, SRV_LOG_OFF);
    assert_int_equal(config.policy.hosts.count, 2);
    assert_string_equal(config.policy.hosts.items[1], "b");
    srv_config_clear(&config);

    assert_true(READ(&config, "--allow-host", "c", "--allow-host=d,e,", "--samples=0"));
    assert_int_equal(config.policy.hosts.count, 3);
    assert_string_equal(config.policy.hosts.items[0], "c");
    assert_string_equal(config.policy.hosts.items[2], "e");
    assert_false(config.samples);
    srv_config_clear(&config);
}

static void numbers_take_a_unit_and_bad_ones_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint64_t value;
    } rows[] = {{"1024", 1024},  {"1k", 1024},    {"1K", 1024},
                {"2M", 2 << 20}, {"1G", 1 << 30}, {"1T", UINT64_C(1) << 40}};
    static const char *const bad[] = {"",
                                      "x",
                                      "-1",
                                      "+1",
                                      "1.5",
                                      "1KB",
                                      "1P",
                                      " 1K",
                                      "1 K",
                                      "0x10",
                                      "1023",
                                      "2T",
                                      "99999999999999999999999",
                                      "18446744073709551615T"};
    srv_config config;
    variables = NULL;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_true(READ(&config, "--max-upload", rows[i].text));
        assert_true(config.max_upload == rows[i].value);
        srv_config_clear(&config);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (READ(&config, "--max-upload", bad[i])) {
            fail_msg("--max-upload \"%s\" was taken", bad[i]);
        }
        assert_non_null(strstr(message, "--max-upload takes a number"));
    }
}

static void bad_options_are_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        const char *words[4];
        const char *says;
    } rows[] = {
        {{"--nope"}, "no option --nope"},
        {{"--"}, "no option --"},
        {{"-x"}, "not an option"},
        {{"--config", "/nowhere/hedged.conf"}, "/nowhere/hedged.conf cannot be read"},
        {{"file"}, "not an option"},
        {{"--listen"}, "--listen needs a value"},
        {{"--listen", "8080"}, "--listen takes"},
        {{"--listen", "host:80"}, "--listen takes"},
        {{"--listen", "127.0.0.1:65536"}, "--listen takes"},
        {{"--listen", "127.0.0.1:"}, "--listen takes"},
        {{"--listen", "0.0.0.0:80"}, "--tokens, or set --insecure"},
        {{"--listen", "[::]:80"}, "--insecure"},
        {{"--log", "all"}, "auto|access|off"},
        {{"--samples=maybe"}, "0 or 1"},
        {{"--workers", "65"}, "from 0 to 64"},
        {{"--max-meshes", "0"}, "from 1"},
        {{"--backup"}, "--backup needs a value"},
        {{"--restore="}, "--restore needs a value"},
        {{"--dump"}, "--dump needs a value"},
        {{"--verify", "a", "b"}, "not an option"},
        {{"--new-token", "a", "read", "b"}, "not an option"},
        {{"--store", "sqlite:"}, "sqlite:DIR"},
    };
    srv_config config;
    variables = NULL;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_false(read_words(&config, rows[i].words));
        if (strstr(message, rows[i].says) == NULL) {
            fail_msg("%s: %s", rows[i].words[0], message);
        }
    }
    static const char *const set[] = {"HEDGE_WORKERS", "many", NULL};
    variables = set;
    assert_false(read_words(&config, (const char *const[]){NULL}));
    assert_non_null(strstr(message, "HEDGE_WORKERS"));
    static const char *const insecure[] = {"HEDGE_INSECURE", "1", NULL};
    variables = insecure;
    assert_true(READ(&config, "--listen", "0.0.0.0:80"));
    srv_config_clear(&config);
    static const char *const tokens[] = {"HEDGE_TOKENS", "/file", NULL};
    variables = tokens;
    assert_true(READ(&config, "--listen", "0.0.0.0:80"));
    assert_string_equal(config.tokens, "/file");
    srv_config_clear(&config);
    variables = NULL;
    assert_true(READ(&config, "--listen", "0.0.0.0:80", "--new-token", "alice", "write"));
    assert_string_equal(config.token_name, "alice");
    assert_string_equal(config.token_role, "write");
    srv_config_clear(&config);
}

static void actions_are_taken_from_the_command_line_only(void **state)
{
    (void)state;
    srv_config config;
    variables = NULL;
    assert_true(READ(&config, "--healthcheck", "http://127.0.0.1:1/livez"));
    assert_true(config.healthcheck);
    assert_string_equal(config.healthcheck_url, "http://127.0.0.1:1/livez");
    srv_config_clear(&config);
    assert_true(READ(&config, "--help", "--listen", "nonsense"));
    assert_true(config.help);
    srv_config_clear(&config);
    assert_true(READ(&config, "-h"));
    assert_true(config.help);
    srv_config_clear(&config);
    assert_true(READ(&config, "-V"));
    assert_true(config.version);
    srv_config_clear(&config);
    /* An action such as --help must not be possible by an environment variable, since all commands
     * share the environment. */
    static const char *const set[] = {"HEDGE_HELP", "1", NULL};
    variables = set;
    assert_true(read_words(&config, (const char *const[]){NULL}));
    assert_false(config.help);
    srv_config_clear(&config);
}

/* The output of --print-config must be a valid settings file with equal settings, and --help must
 * name every option that is in this file. */
static void printed_settings_read_back_the_same_and_help_names_them_all(void **state)
{
    (void)state;
    srv_config config, again;
    char printed[4096] = "", twice[4096] = "", help[16384] = "";
    variables = NULL;
    assert_true(READ(&config, "--allow-host", "a,b", "--max-upload", "5M", "--log", "off"));
    FILE *out = fmemopen(printed, sizeof printed, "w");
    srv_config_print(&config, out);
    fclose(out);
    out = fmemopen(help, sizeof help, "w");
    srv_config_help(out);
    fclose(out);
    srv_config_clear(&config);
    assert_non_null(strstr(printed, "allow-host = a,b\n"));
    assert_non_null(strstr(printed, "max-upload = 5242880\n"));
    assert_non_null(strstr(printed, "log = off\n"));

    char *argv[64], flags[64][300];
    int argc = 0;
    for (char *line = printed; *line != '\0' && argc < 64;) {
        char *equals = strstr(line, " = "), *end = strchr(line, '\n');
        assert_true(equals != NULL && end != NULL);
        snprintf(flags[argc], sizeof *flags, "--%.*s=%.*s", (int)(equals - line), line,
                 (int)(end - equals - 3), equals + 3);
        char name[80];
        snprintf(name, sizeof name, "  --%.*s", (int)(equals - line), line);
        assert_non_null(strstr(help, name));
        argv[argc] = flags[argc];
        argc++;
        line = end + 1;
    }
    const srv_config_sources from = {argc, argv, environment};
    assert_true(srv_config_read(&again, &from, message, sizeof message));
    out = fmemopen(twice, sizeof twice, "w");
    srv_config_print(&again, out);
    fclose(out);
    srv_config_clear(&again);
    assert_string_equal(printed, twice);
}

/* Reads a settings file with this text, together with an option on the command line. */
static bool read_file(srv_config *config, const char *text, size_t length, const char *word)
{
    char path[] = "/tmp/settings-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, length), (ssize_t)length);
    close(fd);
    bool ok = READ(config, "--config", path, word);
    unlink(path);
    return ok;
}

static void a_file_weighs_less_than_variables_and_flags(void **state)
{
    (void)state;
    static const char text[] = "# all of them\r\n"
                               "listen = [::1]:7\r\n"
                               "\n"
                               "\tmax-meshes\t=\t5\n"
                               "workers=3\n"
                               "samples\n"
                               "insecure = 0\n"
                               "allow-host = a , b\n"
                               "allow-host = c\n"
                               "allow-origin = https://x\n"
                               "jobs = 4";
    static const char *const set[] = {"HEDGE_WORKERS", "4", "HEDGE_ALLOW_ORIGIN", "https://y",
                                      NULL};
    srv_config config;
    variables = set;
    assert_true(read_file(&config, text, strlen(text), "--max-meshes=6"));
    assert_string_equal(config.listen, "[::1]:7");
    assert_int_equal(config.max_meshes, 6);
    assert_int_equal(config.workers, 4);
    assert_int_equal(config.jobs, 4);
    assert_true(config.samples);
    assert_false(config.insecure);
    assert_int_equal(config.policy.hosts.count, 3);
    assert_string_equal(config.policy.hosts.items[0], "a");
    assert_string_equal(config.policy.hosts.items[1], "b");
    assert_int_equal(config.policy.origins.count, 1);
    assert_string_equal(config.policy.origins.items[0], "https://y");
    srv_config_clear(&config);
    variables = NULL;
}

static void a_frame_is_allowed_by_an_origin_and_nothing_else(void **state)
{
    (void)state;
    srv_config config;
    assert_true(READ(&config, "--allow-frame", "https://a.example,http://localhost:8000",
                     "--allow-frame=https://[::1]:9"));
    assert_int_equal(config.frames.count, 3);
    assert_string_equal(config.frames.items[2], "https://[::1]:9");
    srv_config_clear(&config);
    static const char *const wrong[] = {
        "a.example",    "https://",       "https://:8", "ftp://a",        "https://a/",
        "https://a b",  "https://a;x",    "https://*",  "'self'",         "https://a:b:c",
        "https://[",    "https://[::1",   "https://[]", "https://[::1]9", "https://a:",
        "https://a:8x", "https://[::1]:", "https://a]", "https://[g]"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(READ(&config, "--allow-frame", wrong[i]));
        assert_non_null(strstr(message, "--allow-frame takes the origin"));
    }
}

static void a_line_that_is_wrong_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t length;
        const char *says;
    } rows[] = {
#define ROW(text, says) {(text), sizeof(text) - 1, (says)}
        ROW("\n\nprot = 1\n", ":3: there is no setting \"prot\""),
        ROW("--workers = 1", ":1: there is no setting \"--workers\""),
        ROW("listen", ":1: listen needs a value"),
        ROW("samples\nworkers = 65\n", ":2: workers takes a number from 0 to 64"),
        ROW("samples = maybe", ":1: samples takes 0 or 1"),
        ROW("log = all", ":1: log takes"),
        ROW("config = other", ":1: a configuration file cannot set \"config\""),
        ROW("backup = x", ":1: a configuration file cannot set \"backup\""),
        ROW("help", ":1: a configuration file cannot set \"help\""),
        ROW("= 1", ":1: there is no setting \"\""),
        ROW("samples\nwork\0ers = 1\n", ":2: the line has a zero byte"),
#undef ROW
    };
    srv_config config;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_false(read_file(&config, rows[i].text, rows[i].length, "--samples"));
        if (strstr(message, rows[i].says) == NULL) {
            fail_msg("%s: %s", rows[i].text, message);
        }
    }
    static char large[64 * 1024 + 1];
    memset(large, '\n', sizeof large);
    assert_true(read_file(&config, large, sizeof large - 1, "--samples"));
    srv_config_clear(&config);
    assert_false(read_file(&config, large, sizeof large, "--samples"));
    assert_non_null(strstr(message, "longer than the 65536 bytes"));
}

static void addresses_are_parsed_and_shown_or_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *shown;
        bool loopback;
    } rows[] = {
        {"127.0.0.1:80", "127.0.0.1:80", true},
        {"localhost:0", "127.0.0.1:0", true},
        {"[::1]:65535", "[::1]:65535", true},
        {"10.0.0.1:1", "10.0.0.1:1", false},
        {"[::]:1", "[::]:1", false},
        {"0.0.0.0:1", "0.0.0.0:1", false},
    };
    static const char *const bad[] = {
        "",          ":80",        "1.2.3:80",       "[::1:80", "::1:80",        "[::1]",
        "1.2.3.4:x", "1.2.3.4:-1", "1.2.3.4:000080", "[zz]:80", "example.com:80"};
    srv_address address;
    char shown[SRV_ADDRESS_TEXT];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_true(srv_address_parse(rows[i].text, &address));
        assert_int_equal(srv_address_is_local(&address), rows[i].loopback);
        srv_address_format(&address.socket.any, true, shown);
        assert_string_equal(shown, rows[i].shown);
    }
    srv_address_set_port(&address, 7);
    assert_int_equal(srv_address_port(&address), 7);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (srv_address_parse(bad[i], &address)) {
            fail_msg("\"%s\" was taken for an address", bad[i]);
        }
    }
}

static void a_choice_is_one_of_its_words(void **state)
{
    (void)state;
    srv_config config;
    variables = NULL;
    assert_true(READ(&config, "--log-format", "json", "--log-level=warning", "--log", "access",
                     "--slow", "250"));
    assert_int_equal(config.log_format, SRV_FORMAT_JSON);
    assert_int_equal(config.log_level, 1);
    assert_int_equal(config.log, SRV_LOG_ACCESS);
    assert_int_equal(config.slow, 250);
    srv_config_clear(&config);
    static const char *const wrong[] = {"", "warn", "warnings", "error|warning", "|", "INFO"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(READ(&config, "--log-level", wrong[i]));
        assert_non_null(strstr(message, "--log-level takes error|warning|info|debug"));
    }
}

/* The settings contain a mistake, but also choose the format of the log: the message about the
 * mistake must have the chosen format. */
static void the_format_of_the_log_outlives_a_refusal(void **state)
{
    (void)state;
    srv_config config;
    variables = NULL;
    assert_false(READ(&config, "--log-format", "json", "--workers", "many"));
    assert_int_equal(config.log_format, SRV_FORMAT_JSON);
    assert_false(READ(&config, "--log-format", "text", "--config", "/nowhere/at/all"));
    assert_int_equal(config.log_format, SRV_FORMAT_TEXT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_that_are_not_given_have_defaults),
        cmocka_unit_test(options_override_the_environment),
        cmocka_unit_test(numbers_take_a_unit_and_bad_ones_are_refused),
        cmocka_unit_test(bad_options_are_refused_by_name),
        cmocka_unit_test(actions_are_taken_from_the_command_line_only),
        cmocka_unit_test(printed_settings_read_back_the_same_and_help_names_them_all),
        cmocka_unit_test(addresses_are_parsed_and_shown_or_refused),
        cmocka_unit_test(a_file_weighs_less_than_variables_and_flags),
        cmocka_unit_test(a_frame_is_allowed_by_an_origin_and_nothing_else),
        cmocka_unit_test(a_line_that_is_wrong_is_named),
        cmocka_unit_test(a_choice_is_one_of_its_words),
        cmocka_unit_test(the_format_of_the_log_outlives_a_refusal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
