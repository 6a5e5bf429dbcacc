// nanoflann under the clock. Driven by benches/src/search.rs over standard input, one command a line:
//   build LEAF                 -> seconds
//   knn LEAF K FIRST COUNT     -> seconds, sum of k-th distances
//   radius LEAF R FIRST COUNT  -> seconds, hits, sum of squared distances
// Arguments: a file of points and a file of queries, both three native floats each.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <vector>

struct Cloud {
    std::vector<float> xyz;
    size_t kdtree_get_point_count() const { return xyz.size() / 3; }
    float kdtree_get_pt(size_t i, size_t d) const { return xyz[3 * i + d]; }
    template <class B> bool kdtree_get_bbox(B &) const { return false; }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, uint32_t>;

static std::vector<float> read(const char *path) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    std::vector<float> data(static_cast<size_t>(in.tellg()) / sizeof(float));
    in.seekg(0);
    in.read(reinterpret_cast<char *>(data.data()), static_cast<std::streamsize>(data.size() * sizeof(float)));
    return data;
}

// Processor time of this thread, in seconds.
static double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

// `SearchParams` was renamed and the pair in results became `ResultItem` in nanoflann 1.5.
#if NANOFLANN_VERSION >= 0x150
using Match = nanoflann::ResultItem<uint32_t, float>;
static const nanoflann::SearchParameters unsorted(0.0f, false);
#else
using Match = std::pair<uint32_t, float>;
static const nanoflann::SearchParams unsorted(32, 0.0f, false);
#endif

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    Cloud cloud{read(argv[1])};
    const std::vector<float> queries = read(argv[2]);
    std::map<size_t, std::unique_ptr<Tree>> trees;
    std::vector<uint32_t> indices;
    std::vector<float> distances;
    std::vector<Match> matches;
    std::string command;
    while (std::cin >> command) {
        size_t leaf;
        std::cin >> leaf;
        std::unique_ptr<Tree> &tree = trees[leaf];
        if (command == "build") {
            tree.reset();
            const double start = now();
            tree = std::make_unique<Tree>(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
#if NANOFLANN_VERSION < 0x150
            tree->buildIndex();
#endif
            std::printf("%.9f\n", now() - start);
        } else if (command == "knn") {
            size_t k, first, count;
            std::cin >> k >> first >> count;
            indices.resize(k);
            distances.resize(k);
            const double start = now();
            double sum = 0;
            for (size_t i = first; i < first + count; ++i) {
                nanoflann::KNNResultSet<float, uint32_t> result(k);
                result.init(indices.data(), distances.data());
                tree->findNeighbors(result, &queries[3 * i], unsorted);
                sum += std::sqrt(static_cast<double>(distances[k - 1]));
            }
            std::printf("%.9f %.17g\n", now() - start, sum);
        } else if (command == "radius") {
            float radius;
            size_t first, count;
            std::cin >> radius >> first >> count;
            const double start = now();
            size_t hits = 0;
            double sum = 0;
            for (size_t i = first; i < first + count; ++i) {
                matches.clear();
                hits += tree->radiusSearch(&queries[3 * i], radius * radius, matches, unsorted);
                for (const Match &m : matches) sum += m.second;
            }
            std::printf("%.9f %zu %.17g\n", now() - start, hits, sum);
        } else {
            return 2;
        }
        std::fflush(stdout);
    }
}
