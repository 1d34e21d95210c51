//! The coefficients of Dormand and Prince's method of order 8 with its two error estimates and its
//! interpolant of order 7, as E. Hairer and G. Wanner publish them with Solving Ordinary
//! Differential Equations I (second edition, II.5 and II.6). The tests check them against the order
//! conditions.

/// The index of a stage and the coefficient of its slope.
pub(super) type WeightedStage = (usize, f64);

pub(super) struct Stage {
    /// The time of the stage as a part of the step.
    pub(super) at: f64,
    /// The slopes it is computed from.
    pub(super) from: &'static [WeightedStage],
}

pub(super) const METHOD_STAGES: usize = 12;

/// The stages: those of the method, then its result, whose slope is the first of the next step,
/// then three for the interpolant alone.
pub(super) const STAGES: [Stage; 16] = [
    Stage { at: 0.0, from: &[] },
    Stage { at: 0.052_600_151_958_767_73, from: &[(0, 0.052_600_151_958_767_73)] },
    Stage {
        at: 0.078_900_227_938_151_6,
        from: &[(0, 0.019_725_056_984_537_9), (1, 0.059_175_170_953_613_7)],
    },
    Stage {
        at: 0.118_350_341_907_227_4,
        from: &[(0, 0.029_587_585_476_806_85), (2, 0.088_762_756_430_420_54)],
    },
    Stage {
        at: 0.281_649_658_092_772_6,
        from: &[
            (0, 0.241_365_134_159_266_7),
            (2, -0.884_549_479_328_286_1),
            (3, 0.924_834_003_261_792),
        ],
    },
    Stage {
        at: 0.333_333_333_333_333_3,
        from: &[
            (0, 0.037_037_037_037_037_035),
            (3, 0.170_828_608_729_473_86),
            (4, 0.125_467_687_566_822_42),
        ],
    },
    Stage {
        at: 0.25,
        from: &[
            (0, 0.037_109_375),
            (3, 0.170_252_211_019_544_05),
            (4, 0.060_216_538_980_455_96),
            (5, -0.017_578_125),
        ],
    },
    Stage {
        at: 0.307_692_307_692_307_7,
        from: &[
            (0, 0.037_092_000_118_504_79),
            (3, 0.170_383_925_712_239_98),
            (4, 0.107_262_030_446_373_28),
            (5, -0.015_319_437_748_624_402),
            (6, 0.008_273_789_163_814_023),
        ],
    },
    Stage {
        at: 0.651_282_051_282_051_3,
        from: &[
            (0, 0.624_110_958_716_075_7),
            (3, -3.360_892_629_446_941_4),
            (4, -0.868_219_346_841_726),
            (5, 27.592_099_699_446_71),
            (6, 20.154_067_550_477_894),
            (7, -43.489_884_181_069_96),
        ],
    },
    Stage {
        at: 0.6,
        from: &[
            (0, 0.477_662_536_438_264_34),
            (3, -2.488_114_619_971_667_7),
            (4, -0.590_290_826_836_843),
            (5, 21.230_051_448_181_193),
            (6, 15.279_233_632_882_423),
            (7, -33.288_210_968_984_86),
            (8, -0.020_331_201_708_508_627),
        ],
    },
    Stage {
        at: 0.857_142_857_142_857_1,
        from: &[
            (0, -0.937_142_430_085_987_3),
            (3, 5.186_372_428_844_064),
            (4, 1.091_437_348_996_729_5),
            (5, -8.149_787_010_746_927),
            (6, -18.520_065_659_996_96),
            (7, 22.739_487_099_350_505),
            (8, 2.493_605_552_679_652_3),
            (9, -3.046_764_471_898_219_6),
        ],
    },
    Stage {
        at: 1.0,
        from: &[
            (0, 2.273_310_147_516_538),
            (3, -10.534_495_466_737_25),
            (4, -2.000_872_058_224_862_5),
            (5, -17.958_931_863_118_8),
            (6, 27.948_884_529_419_96),
            (7, -2.858_998_277_135_023_5),
            (8, -8.872_856_933_530_63),
            (9, 12.360_567_175_794_303),
            (10, 0.643_392_746_015_763_6),
        ],
    },
    Stage {
        at: 1.0,
        from: &[
            (0, 0.054_293_734_116_568_765),
            (5, 4.450_312_892_752_409),
            (6, 1.891_517_899_314_500_3),
            (7, -5.801_203_960_010_585),
            (8, 0.311_164_366_957_819_9),
            (9, -0.152_160_949_662_516_1),
            (10, 0.201_365_400_804_030_34),
            (11, 0.044_710_615_727_772_59),
        ],
    },
    Stage {
        at: 0.1,
        from: &[
            (0, 0.056_167_502_283_047_954),
            (6, 0.253_500_210_216_624_83),
            (7, -0.246_239_037_470_802_5),
            (8, -0.124_191_423_263_816_37),
            (9, 0.153_291_798_278_765_68),
            (10, 0.008_201_052_295_634_69),
            (11, 0.007_567_897_660_545_699),
            (12, -0.008_298),
        ],
    },
    Stage {
        at: 0.2,
        from: &[
            (0, 0.031_834_648_163_502_14),
            (5, 0.028_300_909_672_366_776),
            (6, 0.053_541_988_307_438_566),
            (7, -0.054_923_748_571_390_99),
            (10, -0.000_108_347_328_697_249_32),
            (11, 0.000_382_571_090_835_658_4),
            (12, -0.000_340_465_008_687_404_56),
            (13, 0.141_312_443_674_632_5),
        ],
    },
    Stage {
        at: 0.777_777_777_777_777_8,
        from: &[
            (0, -0.428_896_301_583_791_94),
            (5, -4.697_621_415_361_164),
            (6, 7.683_421_196_062_599),
            (7, 4.068_989_818_397_11),
            (8, 0.356_727_187_455_281_1),
            (12, -0.001_399_024_165_159_014_5),
            (13, 2.947_514_789_152_772_4),
            (14, -9.150_958_472_179_87),
        ],
    },
];

/// The weights of an embedded method of order 3.
pub(super) const THIRD: &[WeightedStage] =
    &[(0, 0.244_094_488_188_976_4), (8, 0.733_846_688_281_611_8), (11, 0.022_058_823_529_411_766)];

/// The weights of the error of an embedded method of order 5.
pub(super) const FIFTH: &[WeightedStage] = &[
    (0, 0.013_120_044_994_194_88),
    (5, -1.225_156_446_376_204_4),
    (6, -0.495_758_949_657_250_2),
    (7, 1.664_377_182_454_986_4),
    (8, -0.350_328_848_749_973_66),
    (9, 0.334_179_118_713_017_5),
    (10, 0.081_923_206_485_115_71),
    (11, -0.022_355_307_863_886_294),
];

/// The highest four coefficients of the interpolant, in units of the step.
pub(super) const DENSE: [&[WeightedStage]; 4] = [
    &[
        (0, -8.428_938_276_109_013),
        (5, 0.566_714_953_519_377_7),
        (6, -3.068_949_945_949_891_7),
        (7, 2.384_667_656_512_07),
        (8, 2.117_034_582_445_028),
        (9, -0.871_391_583_777_973),
        (10, 2.240_437_430_260_788_3),
        (11, 0.631_578_778_769_468_8),
        (12, -0.088_990_336_451_333_31),
        (13, 18.148_505_520_854_727),
        (14, -9.194_632_392_478_356),
        (15, -4.436_036_387_594_894),
    ],
    &[
        (0, 10.427_508_642_579_134),
        (5, 242.283_491_775_258_17),
        (6, 165.200_451_717_270_28),
        (7, -374.546_754_722_690_2),
        (8, -22.113_666_853_125_306),
        (9, 7.733_432_668_472_264),
        (10, -30.674_084_731_089_398),
        (11, -9.332_130_526_430_229),
        (12, 15.697_238_121_770_845),
        (13, -31.139_403_219_565_178),
        (14, -9.352_924_358_844_48),
        (15, 35.816_841_486_394_08),
    ],
    &[
        (0, 19.985_053_242_002_433),
        (5, -387.037_308_749_351_8),
        (6, -189.178_138_195_167_58),
        (7, 527.808_159_205_423_6),
        (8, -11.573_902_539_959_63),
        (9, 6.881_232_694_696_3),
        (10, -1.000_605_096_691_083_8),
        (11, 0.777_713_779_805_344_3),
        (12, -2.778_205_752_353_508),
        (13, -60.196_695_231_264_12),
        (14, 84.320_405_506_677_16),
        (15, 11.992_291_136_182_79),
    ],
    &[
        (0, -25.693_933_462_703_75),
        (5, -154.189_748_690_236_43),
        (6, -231.529_379_176_045_5),
        (7, 357.639_117_910_614_1),
        (8, 93.405_324_183_624_24),
        (9, -37.458_323_136_451_63),
        (10, 104.099_649_508_962_3),
        (11, 29.840_293_426_660_5),
        (12, -43.533_456_590_011_14),
        (13, 96.324_553_959_188_28),
        (14, -39.177_261_675_615_44),
        (15, -149.726_836_257_985_64),
    ],
];

#[cfg(test)]
mod tests {
    use super::{FIFTH, METHOD_STAGES, STAGES, THIRD, WeightedStage};

    /// A rooted tree, given by the subtrees of its root in a canonical order, so that equal trees
    /// compare equal.
    #[derive(Clone, PartialEq, PartialOrd, Debug)]
    struct Tree(Vec<Tree>);

    impl Tree {
        fn order(&self) -> usize {
            1 + self.0.iter().map(Tree::order).sum::<usize>()
        }

        fn density(&self) -> f64 {
            self.0.iter().map(Tree::density).product::<f64>() * self.order() as f64
        }

        /// The elementary weight of each stage.
        fn weights(&self) -> Vec<f64> {
            let mut weights = vec![1.0; METHOD_STAGES + 1];
            for branch in &self.0 {
                let below = branch.weights();
                for (w, stage) in weights.iter_mut().zip(&STAGES) {
                    *w *= stage.from.iter().map(|&(j, a)| a * below[j]).sum::<f64>();
                }
            }
            weights
        }
    }

    /// All trees of an order, from adding a leaf to each node of every tree of the order below.
    fn trees(order: usize) -> Vec<Tree> {
        if order == 1 {
            return vec![Tree(Vec::new())];
        }
        let mut found: Vec<Tree> = Vec::new();
        for tree in trees(order - 1).iter().flat_map(grown) {
            if !found.contains(&tree) {
                found.push(tree);
            }
        }
        found
    }

    fn grown(tree: &Tree) -> Vec<Tree> {
        let sorted = |mut branches: Vec<Tree>| {
            branches.sort_by(|a, b| a.partial_cmp(b).expect("trees are comparable"));
            Tree(branches)
        };
        let mut more = tree.0.clone();
        more.push(Tree(Vec::new()));
        let mut all = vec![sorted(more)];
        for (i, branch) in tree.0.iter().enumerate() {
            for taller in grown(branch) {
                let mut branches = tree.0.clone();
                branches[i] = taller;
                all.push(sorted(branches));
            }
        }
        all
    }

    /// The largest error of the conditions Σ b Φ(tree) = 1/γ(tree) of an order.
    fn defect(b: &[WeightedStage], order: usize) -> f64 {
        let of = |tree: &Tree| {
            let weights = tree.weights();
            (b.iter().map(|&(i, b)| b * weights[i]).sum::<f64>() - 1.0 / tree.density()).abs()
        };
        trees(order).iter().map(of).fold(0.0, f64::max)
    }

    #[test]
    fn there_are_as_many_trees_as_cayley_counted() {
        let counts: Vec<usize> = (1..=8).map(|order| trees(order).len()).collect();
        assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]);
    }

    #[test]
    fn every_stage_stands_where_its_slopes_lead() {
        for stage in &STAGES {
            let sum: f64 = stage.from.iter().map(|&(_, a)| a).sum();
            assert!((sum - stage.at).abs() < 2e-14, "{sum} is not {}", stage.at);
        }
    }

    #[test]
    fn the_method_has_order_eight_and_not_nine() {
        let b = STAGES[METHOD_STAGES].from;
        for order in 1..=8 {
            let defect = defect(b, order);
            assert!(defect < 2e-14, "order {order}: {defect:e}");
        }
        assert!(defect(b, 9) > 1e-6);
    }

    #[test]
    fn the_estimates_have_orders_five_and_three() {
        let error: Vec<f64> = (0..METHOD_STAGES).map(|i| coefficient(FIFTH, i)).collect();
        let b: Vec<WeightedStage> = STAGES[METHOD_STAGES].from.to_vec();
        let fifth: Vec<WeightedStage> =
            (0..METHOD_STAGES).map(|i| (i, coefficient(&b, i) - error[i])).collect();
        for (b, order) in [(fifth.as_slice(), 5), (THIRD, 3)] {
            for order in 1..=order {
                let defect = defect(b, order);
                assert!(defect < 2e-14, "order {order}: {defect:e}");
            }
            assert!(defect(b, order + 1) > 1e-6);
        }
    }

    fn coefficient(terms: &[WeightedStage], stage: usize) -> f64 {
        terms.iter().filter(|&&(i, _)| i == stage).map(|&(_, c)| c).sum()
    }
}
