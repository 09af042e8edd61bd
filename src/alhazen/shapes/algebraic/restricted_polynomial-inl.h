/// An expression evaluated over polynomials of one variable; a fragment without a guard, included
/// by polynomial_expression.cpp in namespace alhazen and by kernels in the namespace of each
/// instruction set. Requires `constant_as<Real>(DoubleDouble)` and `divided(Real, double)`,
/// declared before it.

/// [k] binomial coefficient, n over k.
inline const double* binomials(int n) {
    return bernstein::kBinomials<PolynomialExpression::kMaxDegree>[static_cast<std::size_t>(n)]
        .data();
}

/// out = u v, of degrees m and n; coefficients times binomials.
template <class Real>
inline void multiply(const Real* u, int m, const Real* v, int n, Real* out) {
    if (m == 1 && n == 1) {
        out[0] = u[0] * v[0];
        out[1] = u[0] * v[1] + u[1] * v[0];
        out[2] = u[1] * v[1];
        return;
    }
    if (m == 2 && n == 2) {
        out[0] = u[0] * v[0];
        out[1] = u[0] * v[1] + u[1] * v[0];
        out[2] = u[0] * v[2] + u[1] * v[1] + u[2] * v[0];
        out[3] = u[1] * v[2] + u[2] * v[1];
        out[4] = u[2] * v[2];
        return;
    }
    for (int k = 0; k <= n; ++k) out[k] = u[0] * v[k];
    for (int i = 1; i <= m; ++i) {
        for (int k = 0; k < n; ++k) out[i + k] = out[i + k] + u[i] * v[k];
        out[i + n] = u[i] * v[n];
    }
}

/// out += sign * a, raised from degree m to n: times ((1 - u) + u)^(n - m).
template <class Real>
inline void add_raised(const Real* a, int m, int n, double sign, Real* out) {
    const double* row = binomials(n - m);
    for (int i = 0; i <= m; ++i) {
        for (int k = 0; k <= n - m; ++k) out[i + k] = out[i + k] + Real(sign * row[k]) * a[i];
    }
}

/// out = u + sign v, of degrees m and n.
template <class Real>
inline void add(const Real* u, int m, const Real* v, int n, double sign, Real* out) {
    if (m == n) {
        for (int i = 0; i <= n; ++i) out[i] = sign > 0.0 ? u[i] + v[i] : u[i] - v[i];
    } else if (m > n) {
        for (int i = 0; i <= m; ++i) out[i] = u[i];
        add_raised(v, n, m, sign, out);
    } else {
        for (int i = 0; i <= n; ++i) out[i] = sign > 0.0 ? v[i] : -v[i];
        add_raised(u, m, n, 1.0, out);
    }
}

/// Bernstein coefficients of the last node on the segment from p to q, points with x, y and z.
/// `all` is storage for those of all nodes; they become the coefficients times binomials.
template <class Real, class Point>
inline void restrict_nodes(std::span<const PolynomialExpression::Node> nodes, const Point& p,
                           const Point& q, Real* all, Real* b) {
    using enum PolynomialExpression::Op;
    for (const PolynomialExpression::Node& n : nodes) {
        Real* out = all + n.first;
        switch (n.op) {
            case Constant:
                out[0] = constant_as<Real>(n.constant);
                continue;
            case X:
                out[0] = p.x;
                out[1] = q.x;
                continue;
            case Y:
                out[0] = p.y;
                out[1] = q.y;
                continue;
            case Z:
                out[0] = p.z;
                out[1] = q.z;
                continue;
            default:
                break;
        }
        const PolynomialExpression::Node &left = nodes[n.a], &right = nodes[n.b];
        const Real *u = all + left.first, *v = all + right.first;
        if (n.op == Multiply) {
            multiply(u, left.degree, v, right.degree, out);
        } else {
            add(u, left.degree, v, right.degree, n.op == Add ? 1.0 : -1.0, out);
        }
    }
    const PolynomialExpression::Node& root = nodes.back();
    const double* row = binomials(root.degree);
    for (int i = 0; i <= root.degree; ++i) {
        b[i] = divided(all[root.first + i], row[i]);
    }
}
