#include "errors.h"
#include "mex.h"

#include <string.h>

void check(nekton_status status, const nekton_diag *diag, const char *group)
{
    if (status >= 0) return;
    char id[96] = "nekton:", text[256] = "";
    const char *name = nekton_status_name(status);
    strncat(id, group, 30);
    strcat(id, ":");
    strncat(id, name, 50);
    if (diag) nekton_diag_text(diag, text, sizeof text);
    mexErrMsgIdAndTxt(id, "%s", text[0] ? text : nekton_status_text(status));
}
