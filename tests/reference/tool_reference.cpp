#include "tests/reference/tool_reference.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <limits>

namespace tact::reference {

Borne borne(const std::vector<Twist>& bears, const Twist& pull) {
    const std::size_t n = bears.size();
    std::vector<double> w(n, 0.0);
    std::vector<bool> chosen(n, false);
    const double fine = 1e-12 * std::max(pull.norm(), 1e-300);
    const auto sum = [&](const std::vector<double>& by) {
        Twist all = Twist::Zero();
        for (std::size_t i = 0; i < n; ++i) all += by[i] * bears[i];
        return all;
    };
    // The best weights of the chosen ones, of either sign.
    const auto best = [&] {
        std::vector<std::size_t> at;
        for (std::size_t i = 0; i < n; ++i)
            if (chosen[i]) at.push_back(i);
        Eigen::Matrix<double, 6, Eigen::Dynamic> a(6, static_cast<Eigen::Index>(at.size()));
        for (std::size_t k = 0; k < at.size(); ++k) a.col(static_cast<Eigen::Index>(k)) = bears[at[k]];
        const Eigen::VectorXd x = a.completeOrthogonalDecomposition().solve(-pull);
        std::vector<double> all(n, 0.0);
        for (std::size_t k = 0; k < at.size(); ++k) all[at[k]] = x[static_cast<Eigen::Index>(k)];
        return all;
    };
    for (std::size_t round = 0; round < 20 * n + 20; ++round) {
        const Twist left = pull + sum(w);
        std::size_t next = n;
        double most = fine;
        for (std::size_t i = 0; i < n; ++i) {
            if (!chosen[i] && -bears[i].dot(left) > most) {
                most = -bears[i].dot(left);
                next = i;
            }
        }
        if (next == n) break;
        chosen[next] = true;
        for (std::size_t inner = 0; inner <= n; ++inner) {
            const std::vector<double> wanted = best();
            double share = 1.0;
            std::size_t leaves = n;
            for (std::size_t i = 0; i < n; ++i) {
                if (!chosen[i] || wanted[i] > 0.0) continue;
                const double until = w[i] / std::max(w[i] - wanted[i], std::numeric_limits<double>::min());
                if (leaves == n || until < share) {
                    share = until;
                    leaves = i;
                }
            }
            for (std::size_t i = 0; i < n; ++i) w[i] += share * (wanted[i] - w[i]);
            if (leaves == n) break;
            chosen[leaves] = false;
            w[leaves] = 0.0;
        }
    }
    const Twist all = sum(w);
    return {pull + all, all.norm()};
}

ToolJudgement judge_tool(const std::function<Triangles(const Point&, double)>& near, const Ball& ball,
                         const Point& hand, const std::vector<Point>& levers, double gyration,
                         const Twist& pull, double band) {
    ToolJudgement found;
    found.deepest = -1e300;
    std::vector<Twist> bears;
    for (const Point& lever : levers) {
        const Point place = hand + lever;
        const Triangles some = near(place, ball.radius + band);
        for (const auto& c : some.corner) {
            const Nearest n = nearest(some.vertex[c[0]], some.vertex[c[1]], some.vertex[c[2]], place);
            found.deepest = std::max(found.deepest, ball.radius - ball.margin - n.distance);
            const double gap = n.distance - (n.inside ? ball.radius : ball.radius - ball.margin);
            if (gap > band || !(n.distance > 0.0)) continue;
            const Point normal = (place - n.point) / n.distance;
            Twist t;
            t << normal, lever.cross(normal) / gyration;
            bears.push_back(t);
        }
    }
    found.touches = bears.size();
    const Borne b = borne(bears, pull);
    found.borne = b.borne;
    found.left = b.left;
    found.unborne = std::max(0.0, b.left.norm() - ball.friction * b.borne);
    return found;
}

}  // namespace tact::reference
