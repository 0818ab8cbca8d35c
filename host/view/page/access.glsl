// How the formulas read the page's textures.
uniform sampler2D rr_bands, rr_nodes, rr_ratios, rr_spreads, rr_separable, rr_returned;
#define RR_BAND(row, chunk) texelFetch(rr_bands, ivec2(chunk, row), 0)
#define RR_NODE(table, chunk, node) texelFetch(rr_nodes, ivec2(node, (table) * RR_CHUNKS + (chunk)), 0)
#define RR_RATIO(row, place) texelFetch(rr_ratios, ivec2(place, row), 0).x
#define RR_RETURNED(row, azimuth) texelFetch(rr_returned, ivec2(azimuth, row), 0).x
#define RR_SPREAD(row, place) texelFetch(rr_spreads, ivec2(place, row), 0).x
#define RR_SEPARABLE(node) texelFetch(rr_separable, ivec2(node, 0), 0).x
