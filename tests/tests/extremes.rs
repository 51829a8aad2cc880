//! Scenes at the edges of what may be asked: results stay right, or a status or an indicator says that they are not.
