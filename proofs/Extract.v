(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The checkers as OCaml. Whole numbers become those of zarith (GMP); that their operations are right is trusted. *)
From ExactVO Require Import Theorems Plane Checker.
Require Import ZArith QArith.
Require Extraction ExtrOcamlBasic ExtrOcamlNatInt.

Extract Inductive positive => "Whole.t" ["(fun p -> Whole.succ (Whole.shift_left p 1))" "(fun p -> Whole.shift_left p 1)" "Whole.one"]
  "(fun odd even one p -> if Whole.equal p Whole.one then one () else (if Whole.is_odd p then odd else even) (Whole.shift_right p 1))".
Extract Inductive Z => "Whole.t" ["Whole.zero" "(fun p -> p)" "Whole.neg"]
  "(fun zero pos neg z -> let s = Whole.sign z in if s = 0 then zero () else if s > 0 then pos z else neg (Whole.neg z))".
Extract Constant Pos.mul => "Whole.mul".
Extract Constant Pos.eqb => "Whole.equal".
Extract Constant Z.add => "Whole.add".
Extract Constant Z.mul => "Whole.mul".
Extract Constant Z.sub => "Whole.sub".
Extract Constant Z.opp => "Whole.neg".
Extract Constant Z.div => "Whole.fdiv".
Extract Constant Z.eqb => "Whole.equal".
Extract Constant Z.leb => "Whole.leq".
Extract Constant Z.shiftr => "(fun z n -> Whole.shift_right z (Whole.to_int n))".
Extract Constant Z.sqrt => "Whole.sqrt".  (* what it returns is squared and compared *)
Extract Constant Z.double => "(fun z -> Whole.shift_left z 1)".
Extract Constant Z.pred => "Whole.pred".
Extract Constant Z.div2 => "(fun z -> Whole.shift_right z 1)".
Extract Inlined Constant fst => "fst".
Extract Inlined Constant snd => "snd".
Extraction Inline negb.

Extraction "checker.ml" Checked.half_plane_holds Checked.pair_holds Checked.contains Checked.hold Checked.nearest Checked.farthest Checked.least Checked.pinned Checked.contradicted
  Checked.route Checked.chain Checked.blocked Checked.starts Checked.step Checked.brakes Checked.sweep Checked.sweep_past Checked.turn_past Checked.wheels_fit edges_of.
