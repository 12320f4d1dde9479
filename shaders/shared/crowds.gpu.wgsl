// Not so on a GPU, which would keep a network's rows in memory: there is a thread for each particle, which counts the lower ids (arrange_crowded.wgsl).
const NETWORKS: bool = false;
