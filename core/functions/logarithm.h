/* SPDX-License-Identifier: GPL-3.0-or-later */
/* log, log1p, log10, log2 and pow, of  x = 2^k z,  z in [0.705, 1.41):
       log x = k log 2 - log(1/c) + log(1 + r),  r = z (1/c) - 1,  |r| <= .0041,  log(1 + r) = r - r^2/2 + ... - r^8/8
   with 1/c of 11 bits for each 128th part, exactly 1 around z = 1, and r exact as hi + lo. The series ends 2^-65 of
   the value too early; log 2 and log c have two parts, of which sums of the first are exact. Errors in units of the
   last place: log, log10, log2 1/2 for the last sum and .01 for r^2/2; log1p, whose 1 + x is hi + lo, .7.
       x^y = exp(y log x),  y log x = hi + lo
   with a relative error of log x of 2^-65, so of x^y of 2^-55: 1/2 and .1. Tang, ACM TOMS 16 (1990) 378; its table of
   logarithms was computed in 1500 bits. Included for each pass. */
#ifdef GM_PASS_SCALAR
/* 1/c; -log(1/c), as a multiple of 2^-42, whose sum with a multiple of such a part of log 2 is exact; its rest */
static const double gm_logarithm_rows[128][3] = {
    {0x1.6a20000000000p+0, -0x1.6322b01ee6000p-2, -0x1.bfc1acfb0cffbp-46},
    {0x1.6820000000000p+0, -0x1.5d76dd9a78000p-2, 0x1.cbf6c326244f5p-44},
    {0x1.6620000000000p+0, -0x1.57c2f53b05000p-2, -0x1.0494c017c2a52p-45},
    {0x1.6420000000000p+0, -0x1.5206dfd186000p-2, -0x1.c58cfd28f3cd8p-44},
    {0x1.6240000000000p+0, -0x1.4c9f09e153000p-2, 0x1.e1dde70e02de0p-45},
    {0x1.6060000000000p+0, -0x1.472fdbe4fd000p-2, -0x1.f9364c53f821fp-45},
    {0x1.5e80000000000p+0, -0x1.41b941cce1000p-2, 0x1.0469013e43fc9p-44},
    {0x1.5ca0000000000p+0, -0x1.3c3b2736b4000p-2, 0x1.3e5d1e9d3ddf9p-47},
    {0x1.5ac0000000000p+0, -0x1.36b5776bc1000p-2, -0x1.169785a9c223fp-46},
    {0x1.58e0000000000p+0, -0x1.31281d5f11000p-2, 0x1.6e10e6a8b7abcp-48},
    {0x1.5720000000000p+0, -0x1.2bf287cc41000p-2, -0x1.b0f4f549d8ecfp-45},
    {0x1.5560000000000p+0, -0x1.26b6209350000p-2, -0x1.8f08bb3f17379p-44},
    {0x1.53a0000000000p+0, -0x1.2172d5c2ac000p-2, 0x1.115594223fc70p-44},
    {0x1.51e0000000000p+0, -0x1.1c2895218f000p-2, -0x1.5ff09640395a7p-45},
    {0x1.5020000000000p+0, -0x1.16d74c2e8b000p-2, 0x1.cd0784d2e5077p-45},
    {0x1.4e60000000000p+0, -0x1.117ee81dfe000p-2, -0x1.30f778a2e8cbdp-44},
    {0x1.4ca0000000000p+0, -0x1.0c1f55d88b000p-2, 0x1.d7d9ef6c0426bp-44},
    {0x1.4b00000000000p+0, -0x1.071b85fcd6000p-2, 0x1.bcb8ba3e01a11p-44},
    {0x1.4960000000000p+0, -0x1.021164a929000p-2, -0x1.ba287f3b5dd98p-47},
    {0x1.47a0000000000p+0, -0x1.f939c4e72e000p-3, 0x1.4c5fc35fe2798p-44},
    {0x1.4600000000000p+0, -0x1.ef0adcbdc6000p-3, 0x1.b26b79c86af24p-45},
    {0x1.4460000000000p+0, -0x1.e4ceeda61e000p-3, 0x1.2ccbe398170f7p-46},
    {0x1.42e0000000000p+0, -0x1.db50da24be000p-3, 0x1.9bcb7d201aba8p-44},
    {0x1.4140000000000p+0, -0x1.d0fb7f2256000p-3, 0x1.af52b20633b29p-47},
    {0x1.3fc0000000000p+0, -0x1.c765b9e4d6000p-3, -0x1.1ab6b36976f6cp-44},
    {0x1.3e20000000000p+0, -0x1.bcf6736f7e000p-3, 0x1.271e894f591e4p-44},
    {0x1.3ca0000000000p+0, -0x1.b34885022e000p-3, -0x1.03ba859924374p-44},
    {0x1.3b20000000000p+0, -0x1.a98ed238b8000p-3, -0x1.126ffb47b9ac0p-48},
    {0x1.39a0000000000p+0, -0x1.9fc93e540a000p-3, 0x1.e78b994e84c43p-46},
    {0x1.3820000000000p+0, -0x1.95f7ac2b3c000p-3, 0x1.615d77a1ffe43p-44},
    {0x1.36a0000000000p+0, -0x1.8c19fe2982000p-3, -0x1.5e01e0d7c912bp-49},
    {0x1.3520000000000p+0, -0x1.8230164c1a000p-3, -0x1.98dd68a5d0b48p-46},
    {0x1.33a0000000000p+0, -0x1.7839d62024000p-3, 0x1.55cc584009f24p-44},
    {0x1.3240000000000p+0, -0x1.6f0d28ae56000p-3, -0x1.69737c93373dap-44},
    {0x1.30e0000000000p+0, -0x1.65d5e99cc4000p-3, 0x1.dc4348e559bc8p-46},
    {0x1.2f60000000000p+0, -0x1.5bbc05f140000p-3, -0x1.21892c55da347p-45},
    {0x1.2e00000000000p+0, -0x1.526e5e3a1c000p-3, 0x1.790ba37fc5238p-44},
    {0x1.2ca0000000000p+0, -0x1.4915d832fc000p-3, 0x1.53cee006bcf62p-44},
    {0x1.2b40000000000p+0, -0x1.3fb25a5952000p-3, -0x1.195be6b358ff7p-44},
    {0x1.29e0000000000p+0, -0x1.3643cad058000p-3, -0x1.1e18f2132dfd5p-44},
    {0x1.2880000000000p+0, -0x1.2cca0f5f60000p-3, 0x1.b5ef191aff120p-44},
    {0x1.2740000000000p+0, -0x1.2423113ba6000p-3, 0x1.e3a0078ee9d9cp-44},
    {0x1.25e0000000000p+0, -0x1.1a93b7d430000p-3, 0x1.3debbf4ec55f3p-44},
    {0x1.24a0000000000p+0, -0x1.11d8e5e290000p-3, -0x1.1c6fa52eaa55bp-45},
    {0x1.2340000000000p+0, -0x1.08338affa2000p-3, -0x1.0533cac823e27p-44},
    {0x1.2200000000000p+0, -0x1.fec9131dc0000p-4, 0x1.54555d1ae6607p-44},
    {0x1.20c0000000000p+0, -0x1.ed1794e838000p-4, 0x1.fd143749d0484p-46},
    {0x1.1f80000000000p+0, -0x1.db5270187c000p-4, -0x1.9277856ae181fp-44},
    {0x1.1e20000000000p+0, -0x1.c7af7a8474000p-4, 0x1.289ae375f8578p-44},
    {0x1.1d00000000000p+0, -0x1.b78c82bb10000p-4, 0x1.25ef7bc3987e7p-44},
    {0x1.1bc0000000000p+0, -0x1.a58b60c2b4000p-4, 0x1.cdc735c5c9f2ap-44},
    {0x1.1a80000000000p+0, -0x1.9375e55594000p-4, -0x1.eddc37380c364p-44},
    {0x1.1940000000000p+0, -0x1.814be23f8c000p-4, -0x1.b2381da82fdfdp-51},
    {0x1.1820000000000p+0, -0x1.70e12b325c000p-4, -0x1.0530d95714cd1p-45},
    {0x1.16e0000000000p+0, -0x1.5e8fa4d858000p-4, -0x1.1c6fce08d7110p-44},
    {0x1.15c0000000000p+0, -0x1.4e01108a34000p-4, -0x1.ae5cfdf2c5ae5p-44},
    {0x1.1480000000000p+0, -0x1.3b87598b1c000p-4, 0x1.2241594aca313p-45},
    {0x1.1360000000000p+0, -0x1.2ad449eff4000p-4, 0x1.cea3ae5f05b87p-44},
    {0x1.1240000000000p+0, -0x1.1a0fba1bf8000p-4, -0x1.4a3fcc319d6dcp-45},
    {0x1.1120000000000p+0, -0x1.0939853a1c000p-4, -0x1.91761e583dc8fp-45},
    {0x1.0fe0000000000p+0, -0x1.ecdf0f87b8000p-5, 0x1.e97bceb5803f8p-45},
    {0x1.0ec0000000000p+0, -0x1.cae72fb960000p-5, 0x1.efabf2025b1bep-44},
    {0x1.0dc0000000000p+0, -0x1.ac97221710000p-5, -0x1.f8d3ef013222cp-45},
    {0x1.0ca0000000000p+0, -0x1.8a5a9cc618000p-5, 0x1.9ae2900180e9ap-44},
    {0x1.0b80000000000p+0, -0x1.67f94f0948000p-5, -0x1.ecc1f3e7e4ed7p-44},
    {0x1.0a60000000000p+0, -0x1.4572e981c8000p-5, -0x1.6c7eaf9b37d75p-44},
    {0x1.0960000000000p+0, -0x1.26a32a86d0000p-5, -0x1.7b8f856a40770p-44},
    {0x1.0840000000000p+0, -0x1.03d5d85e70000p-5, -0x1.f778960ed29cfp-44},
    {0x1.0740000000000p+0, -0x1.c98d18d010000p-6, 0x1.bf6150589df0fp-45},
    {0x1.0620000000000p+0, -0x1.83624fba80000p-6, -0x1.deb9c96b40046p-45},
    {0x1.0520000000000p+0, -0x1.44c28d4510000p-6, -0x1.98b0a50467942p-44},
    {0x1.0420000000000p+0, -0x1.05e5478270000p-6, 0x1.0dbde21f5e1f8p-44},
    {0x1.0300000000000p+0, -0x1.7dc475f820000p-7, 0x1.eb1245b5da1f5p-44},
    {0x1.0200000000000p+0, -0x1.fe02a6b100000p-8, -0x1.9e23f0dda40e4p-46},
    {0x1.0100000000000p+0, -0x1.ff00aa2b00000p-9, -0x1.0bc04a086b56ap-45},
    {0x1.0000000000000p+0, 0, 0},
    {0x1.fc00000000000p-1, 0x1.0101575880000p-7, 0x1.bce251998b506p-44},
    {0x1.f800000000000p-1, 0x1.0205658930000p-6, 0x1.611d27c8e8417p-44},
    {0x1.f440000000000p-1, 0x1.7c61b1cf60000p-6, -0x1.08fc8f849a447p-45},
    {0x1.f080000000000p-1, 0x1.f7a9b16780000p-6, 0x1.42ad9271be7d7p-45},
    {0x1.ecc0000000000p-1, 0x1.39f07ba0e8000p-5, 0x1.eb129d642e577p-44},
    {0x1.e900000000000p-1, 0x1.788595a358000p-5, -0x1.08b0d083b3a4cp-46},
    {0x1.e580000000000p-1, 0x1.b35dd9b588000p-5, 0x1.d5674d6cf558ep-44},
    {0x1.e200000000000p-1, 0x1.eea31c0068000p-5, 0x1.c3dd83606d891p-44},
    {0x1.de40000000000p-1, 0x1.174f76ab08000p-4, 0x1.1710317ee2e48p-44},
    {0x1.db00000000000p-1, 0x1.333d7f8184000p-4, -0x1.692b6a81b8848p-49},
    {0x1.d780000000000p-1, 0x1.5188742260000p-4, 0x1.30a1d96258b3ep-44},
    {0x1.d400000000000p-1, 0x1.700d30aeac000p-4, 0x1.c1e8da99ded32p-49},
    {0x1.d0c0000000000p-1, 0x1.8c985e9ba0000p-4, -0x1.37c377e430036p-44},
    {0x1.cd80000000000p-1, 0x1.a956d3ecac000p-4, 0x1.e63794c02c4afp-44},
    {0x1.ca40000000000p-1, 0x1.c6494a2e40000p-4, 0x1.8a5e8ab20c4e6p-44},
    {0x1.c700000000000p-1, 0x1.e3707ee304000p-4, 0x1.0f684e6766abdp-45},
    {0x1.c400000000000p-1, 0x1.fe89139dbc000p-4, 0x1.56594d82f7a82p-44},
    {0x1.c100000000000p-1, 0x1.0ce7ecdccc000p-3, 0x1.4652dabff5447p-46},
    {0x1.bdc0000000000p-1, 0x1.1bc8af2144000p-3, -0x1.2994d823555d4p-44},
    {0x1.bac0000000000p-1, 0x1.299d30c606000p-3, 0x1.d4d0079dc08d9p-44},
    {0x1.b7c0000000000p-1, 0x1.3789c4c042000p-3, -0x1.992c2eecb3868p-44},
    {0x1.b500000000000p-1, 0x1.4462b9dc9c000p-3, -0x1.84858a711b062p-44},
    {0x1.b200000000000p-1, 0x1.527e5e4a1c000p-3, -0x1.4e60b8d4b411dp-44},
    {0x1.af40000000000p-1, 0x1.5f830a1a5c000p-3, 0x1.5226898ffc1bcp-44},
    {0x1.ac40000000000p-1, 0x1.6dcf0165f8000p-3, 0x1.b95669a33e4c6p-46},
    {0x1.a980000000000p-1, 0x1.7b00916516000p-3, -0x1.ae75fcb067e57p-44},
    {0x1.a6c0000000000p-1, 0x1.884807ce56000p-3, 0x1.c77cef4a8712cp-46},
    {0x1.a400000000000p-1, 0x1.95a5adcf70000p-3, 0x1.7f22858a0ff6fp-47},
    {0x1.a180000000000p-1, 0x1.a1dfc40f1c000p-3, -0x1.01e0f004f3781p-44},
    {0x1.9ec0000000000p-1, 0x1.af6895610e000p-3, -0x1.148288bf7a937p-45},
    {0x1.9c40000000000p-1, 0x1.bbca696b08000p-3, -0x1.7fdd0ae06cee0p-47},
    {0x1.9980000000000p-1, 0x1.c97f8079d4000p-3, 0x1.3b161a8c6e6c5p-45},
    {0x1.9700000000000p-1, 0x1.d60a17f904000p-3, -0x1.5d6e06fc20d39p-44},
    {0x1.9480000000000p-1, 0x1.e2a877a6b2000p-3, 0x1.823817787081ap-44},
    {0x1.9200000000000p-1, 0x1.ef5ade4dd0000p-3, -0x1.a211565bb8e11p-51},
    {0x1.8f80000000000p-1, 0x1.fc218be620000p-3, 0x1.4bba46f1cf6a0p-44},
    {0x1.8d40000000000p-1, 0x1.03d95a1d67000p-2, 0x1.a17880f236109p-44},
    {0x1.8ac0000000000p-1, 0x1.0a504e97bb000p-2, 0x1.03094e6690c44p-44},
    {0x1.8880000000000p-1, 0x1.102ac0a35d000p-2, -0x1.f1fbddfdfd686p-45},
    {0x1.8600000000000p-1, 0x1.16b5ccbad0000p-2, -0x1.23299042d74bfp-44},
    {0x1.83c0000000000p-1, 0x1.1ca28c64bb000p-2, -0x1.ac4f842f5566bp-46},
    {0x1.8180000000000p-1, 0x1.22981fbef8000p-2, -0x1.a1421609580dap-44},
    {0x1.7f40000000000p-1, 0x1.2896a13e08000p-2, 0x1.a8ed027e16952p-44},
    {0x1.7d00000000000p-1, 0x1.2e9e2bce12000p-2, 0x1.4300c128d1dc2p-45},
    {0x1.7ac0000000000p-1, 0x1.34aedad5b1000p-2, 0x1.a2aacf2be1fddp-44},
    {0x1.78c0000000000p-1, 0x1.3a1ac802f3000p-2, 0x1.98ecf399abd8dp-44},
    {0x1.7680000000000p-1, 0x1.403d086cea000p-2, 0x1.e6ef574487308p-44},
    {0x1.7440000000000p-1, 0x1.4668bf41f0000p-2, -0x1.9af1762c5a8f7p-44},
    {0x1.7240000000000p-1, 0x1.4becf95d98000p-2, -0x1.bb33b20023a70p-44},
    {0x1.7040000000000p-1, 0x1.5178d9ab55000p-2, 0x1.5c1530fe963b3p-44},
    {0x1.6e00000000000p-1, 0x1.57bf753c8d000p-2, 0x1.fadedee5d40efp-46},
    {0x1.6c00000000000p-1, 0x1.5d5bddf596000p-2, -0x1.a0b2a08a465dcp-47},
};
#endif

/* log(x + x part) for x > 0, |part| below 2^-52, with a relative error of 2^-65, or if it need not be `exact` of
   2^-61 */
GM_INLINE struct K(pair) K(logarithm)(real x, real part_of_x, bool exact)
{
    const mask tiny = x < 0x1p-1022;
    const real y = K(pick)(tiny, x * 0x1p54, x);
    /* the exponent of y / 0.705, biased, and the row */
    const pattern bits = K(bits)(y), over = bits + 0x0009700000000000;
    const real k = (K(number)(over >> 52 | (uint64_t)0x433 << 52) - (0x1p52 + 1023)) -
                   K(pick)(tiny, K(constant)(54), K(constant)(0));
    const pattern row_of = over >> 45 & 127;
    const real z = K(number)(bits - (over & (uint64_t)0xfff << 52) + ((uint64_t)1023 << 52));
    real inverse = z, table_hi = z, table_lo = z;
    for (int l = 0; l < GM_LANES; l++) {
        const double *row = gm_logarithm_rows[K(pattern_lane)(row_of, l)];
        K(set_lane)(&inverse, l, row[0]);
        K(set_lane)(&table_hi, l, row[1]);
        K(set_lane)(&table_lo, l, row[2]);
    }
    const real head = K(head)(z);
    struct K(pair) r = K(any_sum)(head * inverse - 1, (z - head) * inverse);
    r.lo = r.lo + (part_of_x + part_of_x * r.hi);
    const real half = K(head)(r.hi), rr = r.hi * r.hi,
               /* r^2/2 exactly, as half^2/2 and the rest */
        rest = 0.5 * ((r.hi - half) * (r.hi + half)),
               series =
                   rr * r.hi *
                   ((0x1.5555555555555p-2 - r.hi * 0.25) +
                    rr * ((0.2 - r.hi * 0x1.5555555555555p-3) + rr * (0x1.2492492492492p-3 - r.hi * 0.125)));
    const struct K(pair) first = K(sum)(k * 0x1.62e42fefa38p-1 + table_hi, r.hi);
    if (!exact) {
        return (struct K(pair)){first.hi, first.lo + ((k * 0x1.ef35793c7673p-45 + table_lo) +
                                                      ((r.lo - r.lo * r.hi) - 0.5 * rr + series))};
    }
    const struct K(pair) second = K(sum)(first.hi, -0.5 * half * half);
    return K(sum)(second.hi, second.lo + (first.lo + ((k * 0x1.ef35793c7673p-45 + table_lo) +
                                                      ((r.lo - r.lo * r.hi) - rest + series))));
}

/* the logarithm, with its values at 0, infinity, NaN and below 0 */
GM_INLINE real K(of_any)(real x, real value)
{
    if (K(everywhere)(K(both)(x > 0, x <= 0x1.fffffffffffffp1023))) {
        return value;
    }
    value = K(pick)(x > 0, K(pick)(x > 0x1.fffffffffffffp1023, x, value), K(constant)(NAN));
    return K(pick)(x == 0, K(constant)(-INFINITY), value);
}

GM_FUNCTION_OF_PASS real K(log)(real x)
{
    const struct K(pair) log = K(logarithm)(x, K(constant)(0), false);
    return K(of_any)(x, log.hi + log.lo);
}

/* log x / log b, with 1 / log b as hi + lo */
GM_INLINE real K(logarithm_to)(real x, double hi, double lo)
{
    const struct K(pair) log = K(logarithm)(x, K(constant)(0), false),
                         p = K(product)(log.hi, K(constant)(hi));
    return K(of_any)(x, p.hi + (p.lo + (log.hi * lo + log.lo * hi)));
}

GM_FUNCTION_OF_PASS real K(log10)(real x)
{
    return K(logarithm_to)(x, 0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57);
}

GM_FUNCTION_OF_PASS real K(log2)(real x)
{
    return K(logarithm_to)(x, 0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56);
}

GM_FUNCTION_OF_PASS real K(log1p)(real x)
{
    const struct K(pair) one = K(any_sum)(K(constant)(1), x),
                         log = K(logarithm)(one.hi, one.lo / one.hi, false);
    return K(pick)(K(magnitude)(x) < 0x1p-54, x, K(of_any)(one.hi, log.hi + log.lo));
}

/* The values of pow at 0, infinity, NaN and x < 0 (C17, F.10.4.4). Elsewhere it is power = |x|^y, negative where an
   odd power of a negative number is taken. */
static __attribute__((noinline, cold, unused)) real K(power_of_any)(real x, real y, real power)
{
    const real size = K(magnitude)(x), exponent = K(magnitude)(y),
               product = y * K(of_any)(size, size - 1); /* the sign of y log |x|, infinite if that is */
    const mask without =
        K(either)(K(either)(size == 0, size > 0x1.fffffffffffffp1023), exponent > 0x1.fffffffffffffp1023);
    power = K(pick)(without, K(pick)(product > 0, K(constant)(INFINITY), K(constant)(0)), power);
    const mask fraction = K(both)(exponent < 0x1p52, (exponent + 0x1p52) - 0x1p52 != exponent);
    const real last = K(pick)(exponent < 0x1p52, exponent + 0x1p52, exponent);
    const pattern odd = K(pick_bits)(K(both)(exponent < 0x1p53, K(other)(fraction)), K(bits)(last) & 1);
    const pattern negative = K(bits)(x) >> 63;
    power = K(number)(K(bits)(power) | (odd & negative) << 63);
    power =
        K(pick)(K(both)(K(both)(x < 0, size <= 0x1.fffffffffffffp1023), fraction), K(constant)(NAN), power);
    power = K(pick)(K(either)(x != x, y != y), x + y, power);
    return K(pick)(K(either)(K(either)(y == 0, x == 1), K(both)(x == -1, exponent > 0x1.fffffffffffffp1023)),
                   K(constant)(1), power);
}

GM_FUNCTION_OF_PASS real K(pow)(real x, real y)
{
    const struct K(pair) log = K(logarithm)(K(magnitude)(x), K(constant)(0), true), p = K(product)(log.hi, y);
    const real power = K(exp_of)(p.hi, p.lo + log.lo * y);
    const mask common =
        K(both)(K(both)(x > 0, x <= 0x1.fffffffffffffp1023), K(magnitude)(y) <= 0x1.fffffffffffffp1023);
    return __builtin_expect(K(everywhere)(common), 1) ? power : K(power_of_any)(x, y, power);
}
