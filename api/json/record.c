#include "api/json/record.h"

#include <string.h>

/* Returns true if a text is the name of a type, or that name and a question mark. */
static bool is_name(const char *text, const char *name)
{
    const size_t length = strlen(name);
    if (strncmp(text, name, length) != 0) {
        return false;
    }
    const char *rest = text + length;
    return *rest == '\0' || strcmp(rest, "?") == 0;
}

static bool is_type(const api_field *field, const char *type)
{
    return is_name(field->type, type);
}

static bool is_nullable(const api_field *field)
{
    return field->type[strlen(field->type) - 1] == '?';
}

static bool is_zero(const api_field *field, const void *at)
{
    switch (field->form) {
    case API_FORM_NONE:
    case API_FORM_TEXTS:
    case API_FORM_VEC3:
        return false;
    case API_FORM_BOOL:
        return !*(const bool *)at;
    case API_FORM_INT:
        return *(const int *)at == 0;
    case API_FORM_I64:
        return *(const int64_t *)at == 0;
    case API_FORM_U32:
        return *(const uint32_t *)at == 0;
    case API_FORM_U64:
        return *(const uint64_t *)at == 0;
    case API_FORM_DOUBLE:
        return *(const double *)at == 0;
    case API_FORM_TEXT:
        return (*(const char *const *)at)[0] == '\0';
    case API_FORM_CHARS:
        return *(const char *)at == '\0';
    }
    return false;
}

static bool has_value(const api_field *field, const char *value)
{
    const void *at = value + field->offset;
    if (field->known != 0 && !*(const bool *)(const void *)(value + field->known - 1)) {
        return false;
    }
    if (field->form == API_FORM_TEXT && *(const char *const *)at == NULL) {
        return false;
    }
    if (field->form == API_FORM_TEXTS && *(const char *const *const *)at == NULL) {
        return false;
    }
    return !field->zero_is_none || !is_zero(field, at);
}

static void write_texts(api_out *out, const char *const *texts)
{
    api_out_array_begin(out);
    for (; *texts != NULL; texts++) {
        api_out_string(out, *texts);
    }
    api_out_array_end(out);
}

static void write_value(api_out *out, const api_field *field, const char *value)
{
    const void *at = value + field->offset;
    switch (field->form) {
    case API_FORM_NONE:
        if (field->record != NULL) {
            api_record_write(out, field->record, at);
        } else {
            field->write(out, at);
        }
        break;
    case API_FORM_BOOL:
        api_out_bool(out, *(const bool *)at);
        break;
    case API_FORM_INT:
        api_out_i64(out, *(const int *)at);
        break;
    case API_FORM_I64:
        api_out_i64(out, *(const int64_t *)at);
        break;
    case API_FORM_U32:
        if (is_type(field, "id")) {
            api_out_id(out, *(const uint32_t *)at);
        } else {
            api_out_u64(out, *(const uint32_t *)at);
        }
        break;
    case API_FORM_U64:
        api_out_u64(out, *(const uint64_t *)at);
        break;
    case API_FORM_DOUBLE:
        if (is_type(field, "time")) {
            api_out_time(out, *(const double *)at);
        } else {
            api_out_number(out, *(const double *)at);
        }
        break;
    case API_FORM_TEXT:
        api_out_string(out, *(const char *const *)at);
        break;
    case API_FORM_CHARS:
        api_out_string(out, at);
        break;
    case API_FORM_TEXTS:
        write_texts(out, *(const char *const *const *)at);
        break;
    case API_FORM_VEC3:
        api_out_vec3(out, *(const he_vec3 *)at);
        break;
    }
}

void api_record_members(api_out *out, const api_record *record, const void *value)
{
    for (size_t i = 0; i < record->count; i++) {
        const api_field *field = &record->fields[i];
        if (has_value(field, value)) {
            api_out_key(out, field->name);
            write_value(out, field, value);
        } else if (field->required) {
            api_out_key_null(out, field->name);
        }
    }
}

void api_record_write(api_out *out, const api_record *record, const void *value)
{
    api_out_object_begin(out);
    api_record_members(out, record, value);
    api_out_object_end(out);
}

/* Returns true if the member always has a value, or if its schema allows that it has none. */
static bool is_missing_allowed(const api_field *field)
{
    return !field->required || is_nullable(field) || (field->known == 0 && !field->zero_is_none);
}

bool api_field_fits(const api_field *field)
{
    const bool made = field->write != NULL, nested = field->record != NULL;
    if (!is_missing_allowed(field) || (made && nested) ||
        (field->form == API_FORM_NONE) != (made || nested)) {
        return false;
    }
    switch (field->form) {
    case API_FORM_NONE:
        return !nested ||
               (field->type[0] == '#' && is_name(field->type + 1, field->record->schema));
    case API_FORM_BOOL:
        return is_type(field, "flag");
    case API_FORM_INT:
    case API_FORM_I64:
        return is_type(field, "integer");
    case API_FORM_U32:
        return is_type(field, "count") || is_type(field, "id");
    case API_FORM_U64:
        return is_type(field, "count");
    case API_FORM_DOUBLE:
        return is_type(field, "number") || is_type(field, "time") ||
               field->type[0] == '#'; /* a number within limits */
    case API_FORM_TEXT:
    case API_FORM_CHARS:
        return is_type(field, "text") || field->type[0] == '#'; /* a name of an enumeration */
    case API_FORM_TEXTS:
        return is_type(field, "*text");
    case API_FORM_VEC3:
        return is_type(field, "point");
    }
    return false;
}
