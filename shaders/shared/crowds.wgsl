// Whether the thread that collides a crowded cell's particles puts them in order by itself, with a network. (What their order is of no matter to.)
const NETWORKS: bool = true;
