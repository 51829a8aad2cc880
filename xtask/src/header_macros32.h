/* Memory for static placement, bytes: as NEKTON_MODEL_BYTES and NEKTON_SIM_BYTES. */
#define NEKTON32_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     4 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded))
#define NEKTON32_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (1024 + 4 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded))

/* Filled by their own size, as in nekton.h. */
#define nekton32_wall_def_init(def) nekton32_wall_def_init((def), sizeof(nekton32_wall_def), NEKTON_ABI_VERSION)
#define nekton32_body_def_init(def) nekton32_body_def_init((def), sizeof(nekton32_body_def), NEKTON_ABI_VERSION)
#define nekton32_link_def_init(def) nekton32_link_def_init((def), sizeof(nekton32_link_def), NEKTON_ABI_VERSION)
#define nekton32_method_init(def) nekton32_method_init((def), sizeof(nekton32_method), NEKTON_ABI_VERSION)
