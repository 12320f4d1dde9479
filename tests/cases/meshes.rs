//! Meshes of STL and OBJ: what is read, and what is refused with its line.
