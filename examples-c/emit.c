/* Writes the equations of a heavy top as top.h and top.c, which need no library, into the directory given. */
#include <stdio.h>

#include "pc.h"

static int save(const char *directory, const char *name, const char *text)
{
    char path[4096];
    FILE *file;
    int ok;
    if (snprintf(path, sizeof path, "%s/%s", directory, name) >= (int)sizeof path) {
        return 0;
    }
    file = fopen(path, "w");
    if (!file) {
        perror(path);
        return 0;
    }
    ok = fputs(text, file) >= 0;
    return fclose(file) == 0 && ok;
}

int main(int argc, char **argv)
{
    const char *directory = argc > 1 ? argv[1] : ".";
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_error *error = NULL;
    char *header = NULL, *source = NULL;
    int ok = pc_model_builtin("heavy-top-lagrange", &model, &error) == PC_OK &&
             pc_system_new(model, NULL, &top, &error) == PC_OK &&
             pc_system_emit_c(top, "top", 10.0, &header, &source, &error) == PC_OK;
    if (!ok) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    ok = ok && save(directory, "top.h", header) && save(directory, "top.c", source);
    pc_string_free(header);
    pc_string_free(source);
    pc_error_free(error);
    pc_system_free(top);
    pc_model_free(model);
    return ok ? 0 : 1;
}
