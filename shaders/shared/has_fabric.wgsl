// Whether the scene has fabric. Else not a line more is compiled.

override FABRIC: bool = false;
