/* nekton next to another static library in Rust: both work. */
#include <nekton.h>
#include <stddef.h>

size_t other(void);

int main(void)
{
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def link;
    nekton_model *model = NULL;
    if (other() != 42)
        return 1;
    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 2;
    nekton_body_def_init(&body);
    nekton_link_def_init(&link);
    link.shape.kind = NEKTON_SHAPE_STAR;
    link.shape.radius = 1.0;
    link.shape.lobes = 5;
    link.shape.amplitude = 0.2;
    body.links = &link;
    body.link_count = 1;
    scene.bodies = &body;
    scene.body_count = 1;
    if (nekton_model_create(&scene, &model, NULL) != NEKTON_OK)
        return 3;
    return nekton_model_free(model) == NEKTON_OK ? 0 : 4;
}
