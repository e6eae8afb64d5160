(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Sines and cosines of fractions, enclosed in whole numbers of 1/g: by their series where the angle is small; of other
   angles by halving them, and doubling back. *)
Require Import Reals QArith Qreals List Bool ZArith Lra Lia Psatz.
From ExactVO Require Import Theorems Plane.
Open Scope R_scope.

(* --- Quotients rounded down --- *)
Lemma div_low p q : (0 < q)%Z -> IZR (p / q) * IZR q <= IZR p.
Proof. intro h. rewrite <- mult_IZR. apply IZR_le. rewrite Z.mul_comm. now apply Z.mul_div_le. Qed.
Lemma div_high p q : (0 < q)%Z -> IZR p <= (IZR (p / q) + 1) * IZR q.
Proof.
  intro h. rewrite <- plus_IZR, <- mult_IZR. apply IZR_le. rewrite Z.mul_comm. apply Z.lt_le_incl. rewrite Z.add_1_r. now apply Z.mul_succ_div_gt.
Qed.

(* The units: to divide by them is to shift, which the kernel too does fast. Mostly the coarse one is fine enough. *)
Definition grain : positive := Pos.pow 2 256.
Definition grain_bits : Z := 256.
Definition coarse : positive := Pos.pow 2 60.
Definition coarse_bits : Z := 60.
Definition over (g : positive) (p : Z) : Z :=
  if Pos.eqb g coarse then Z.shiftr p coarse_bits else if Pos.eqb g grain then Z.shiftr p grain_bits else Z.div p (Zpos g).
Lemma over_ok g p : over g p = (p / Zpos g)%Z.
Proof.
  unfold over. destruct (Pos.eqb_spec g coarse) as [e|_]; [|destruct (Pos.eqb_spec g grain) as [e|_]; [|reflexivity]]; rewrite e.
  - unfold coarse. rewrite Pos2Z.inj_pow. now apply Z.shiftr_div_pow2.
  - unfold grain. rewrite Pos2Z.inj_pow. now apply Z.shiftr_div_pow2.
Qed.

(* Products in these units, at most two below: of coarse ones in parts of 30 bits, as then every number fits a machine word. *)
Definition part_bits : Z := 30.
Definition part_units : Z := 2 ^ 30.
Definition times_over (g : positive) (x y : Z) : Z :=
  if Pos.eqb g coarse then
    let u := Z.shiftr x part_bits in let v := Z.shiftr y part_bits in
    (u * v + Z.shiftr (u * (y - v * part_units) + (x - u * part_units) * v) part_bits)%Z
  else over g (x * y).
Lemma times_over_ok g x y : (times_over g x y * Zpos g <= x * y <= (times_over g x y + 2) * Zpos g)%Z.
Proof.
  assert (parts : forall a b, (0 < b)%Z -> (0 <= a - a / b * b < b)%Z).
  { intros a b h. pose proof (Z.mul_div_le a b h). pose proof (Z.mul_succ_div_gt a b h). lia. }
  unfold times_over. destruct (Pos.eqb_spec g coarse) as [e|_].
  - subst g. cbv zeta. change (Zpos coarse) with (2 ^ 30 * 2 ^ 30)%Z. unfold part_bits, part_units. rewrite !Z.shiftr_div_pow2 by discriminate.
    set (b := (2 ^ 30)%Z). assert (b0 : (0 < b)%Z) by reflexivity. clearbody b.
    pose proof (parts x b b0) as hx. pose proof (parts y b b0) as hy. set (u := (x / b)%Z) in *. set (v := (y / b)%Z) in *. clearbody u v.
    set (x0 := (x - u * b)%Z) in *. set (y0 := (y - v * b)%Z) in *. assert (ex : x = (u * b + x0)%Z) by (unfold x0; ring). assert (ey : y = (v * b + y0)%Z) by (unfold y0; ring).
    clearbody x0 y0. pose proof (parts (u * y0 + x0 * v)%Z b b0) as hm. set (m := ((u * y0 + x0 * v) / b)%Z) in *. clearbody m. subst x y.
    assert (low : (0 <= x0 * y0 <= b * b)%Z) by (split; [apply Z.mul_nonneg_nonneg|apply Z.mul_le_mono_nonneg]; lia).
    set (r := (u * y0 + x0 * v - m * b)%Z) in *. assert (br : (0 <= b * r <= b * b)%Z) by (split; [apply Z.mul_nonneg_nonneg|apply Z.mul_le_mono_nonneg_l]; lia).
    assert (all : ((u * b + x0) * (v * b + y0) = (u * v + m) * (b * b) + b * r + x0 * y0)%Z) by (unfold r; ring). rewrite all. lia.
  - rewrite over_ok. pose proof (parts (x * y)%Z (Zpos g) eq_refl). lia.
Qed.

(* --- The series: 1 - x / ((j + 1) (j + 2)) (1 - x / ((j + 3) (j + 4)) ...), for x the square of the angle --- *)
Fixpoint tail (x : R) (j : Z) (m : nat) : R :=
  match m with O => 1 | S m => 1 - x / IZR ((j + 1) * (j + 2)) * tail x (j + 2) m end.

Lemma tail_sum x m : forall j, tail x (Z.of_nat j) m = INR (fact j) * sum_f_R0 (fun i => (-1) ^ i * (x ^ i / INR (fact (j + 2 * i)))) m.
Proof.
  induction m as [|m ih]; intro j.
  - simpl. rewrite Nat.add_0_r. field. apply INR_fact_neq_0.
  - cbn [tail]. replace (Z.of_nat j + 2)%Z with (Z.of_nat (j + 2)) by lia. rewrite ih.
    rewrite (decomp_sum _ (S m)) by lia. cbn [Init.Nat.pred].
    rewrite (sum_eq (fun i => (-1) ^ S i * (x ^ S i / INR (fact (j + 2 * S i)))) (fun i => (-1) ^ i * (x ^ i / INR (fact (j + 2 + 2 * i))) * (- x)) m).
    + rewrite <- scal_sum. replace (j + 2 * 0)%nat with j by lia.
      replace (IZR ((Z.of_nat j + 1) * Z.of_nat (j + 2))) with (INR (j + 1) * INR (j + 2)) by (rewrite !INR_IZR_INZ, <- mult_IZR; f_equal; lia).
      replace (INR (fact (j + 2))) with (INR (j + 2) * (INR (j + 1) * INR (fact j))).
      * simpl pow. assert (INR (j + 1) <> 0) by (apply not_0_INR; lia). assert (INR (j + 2) <> 0) by (apply not_0_INR; lia).
        pose proof (INR_fact_neq_0 j). field. auto.
      * rewrite <- !mult_INR. f_equal. replace (j + 2)%nat with (S (S j)) by lia. replace (j + 1)%nat with (S j) by lia. reflexivity.
    + intros i _. replace (j + 2 * S i)%nat with (j + 2 + 2 * i)%nat by lia. simpl pow. field. apply INR_fact_neq_0.
Qed.
Lemma cos_tail a n : cos_approx a n = tail (a * a) 0 n.
Proof.
  change 0%Z with (Z.of_nat 0). rewrite tail_sum. unfold cos_approx. simpl (INR (fact 0)). rewrite Rmult_1_l. apply sum_eq. intros i _.
  unfold cos_term. rewrite pow_mult. simpl (a ^ 2). now rewrite Rmult_1_r.
Qed.
Lemma sin_tail a n : sin_approx a n = a * tail (a * a) 1 n.
Proof.
  change 1%Z with (Z.of_nat 1). rewrite tail_sum. unfold sin_approx. simpl (INR (fact 1)). rewrite Rmult_1_l, scal_sum. apply sum_eq. intros i _.
  unfold sin_term. replace (2 * i + 1)%nat with (1 + 2 * i)%nat by apply Nat.add_comm.
  rewrite (pow_add a 1), (pow_mult a 2). simpl (a ^ 2). simpl (a ^ 1). rewrite !Rmult_1_r. field. apply INR_fact_neq_0.
Qed.

(* The next term changes little. *)
Fixpoint product (j : Z) (m : nat) : Z := match m with O => 1 | S m => (j + 1) * (j + 2) * product (j + 2) m end.
Lemma product_pos m : forall j, (0 <= j)%Z -> (1 <= product j m)%Z.
Proof. induction m as [|m ih]; intros j hj; simpl product; [lia|]. specialize (ih (j + 2)%Z ltac:(lia)). nia. Qed.
Lemma tail_next x m : 0 <= x -> forall j, (0 <= j)%Z -> Rabs (tail x j (S m) - tail x j m) * IZR (product j (S m)) <= x ^ S m.
Proof.
  intro x0. induction m as [|m ih]; intros j j0.
  - cbn [tail product]. rewrite Z.mul_1_r. assert (k : 1 <= IZR ((j + 1) * (j + 2))) by (apply IZR_le; nia). set (K := IZR ((j + 1) * (j + 2))) in *.
    replace (1 - x / K * 1 - 1) with (- (x / K)) by (field; lra). rewrite Rabs_Ropp, Rabs_right by (apply Rle_ge, Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
    simpl pow. right. field. lra.
  - specialize (ih (j + 2)%Z ltac:(lia)). change (tail x j (S (S m))) with (1 - x / IZR ((j + 1) * (j + 2)) * tail x (j + 2) (S m)).
    change (tail x j (S m)) with (1 - x / IZR ((j + 1) * (j + 2)) * tail x (j + 2) m).
    change (product j (S (S m))) with ((j + 1) * (j + 2) * product (j + 2) (S m))%Z. rewrite (mult_IZR ((j + 1) * (j + 2))).
    assert (k : 1 <= IZR ((j + 1) * (j + 2))) by (apply IZR_le; nia). set (K := IZR ((j + 1) * (j + 2))) in *.
    set (p := tail x (j + 2) (S m)) in *. set (q := tail x (j + 2) m) in *. set (P := IZR (product (j + 2) (S m))) in *.
    replace (1 - x / K * p - (1 - x / K * q)) with (- (x / K * (p - q))) by ring. rewrite Rabs_Ropp, Rabs_mult, (Rabs_right (x / K))
      by (apply Rle_ge, Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
    replace (x / K * Rabs (p - q) * (K * P)) with (x * (Rabs (p - q) * P)) by (field; lra).
    change (x ^ S (S m)) with (x * x ^ S m). now apply Rmult_le_compat_l.
Qed.

Lemma within x e : Rabs x <= e -> - e <= x <= e.
Proof. intro h. unfold Rabs in h. destruct (Rcase_abs x); lra. Qed.
(* In whole numbers of 1/g, for x up to 1/4. What has a name is computed once. *)
Definition two : Z := 2.
Fixpoint series (g : positive) (x j : Z) (m : nat) : Z :=
  match m with O => Zpos g | S m => let k := Z.add j two in Zpos g - times_over g x (series g x k m) / (Z.pred k * k) end.
Lemma series_ok g X x : 8 <= IZR (Zpos g) -> 0 <= x <= / 4 -> Rabs (x * IZR (Zpos g) - IZR X) <= 2 -> forall m j, (0 <= j)%Z ->
  0 <= tail x j m <= 1 /\ Rabs (tail x j m * IZR (Zpos g) - IZR (series g X j m)) <= 4.
Proof.
  intros g8 hx hX. induction m as [|m ih]; intros j j0.
  - cbn [tail series]. rewrite Rmult_1_l, Rminus_diag_eq, Rabs_R0 by reflexivity. lra.
  - specialize (ih (j + 2)%Z ltac:(lia)). cbn [tail series]. unfold two. cbv zeta. replace (Z.pred (j + 2)) with (j + 1)%Z by lia.
    set (V := series g X (j + 2) m) in *. set (t := tail x (j + 2) m) in *. set (k := ((j + 1) * (j + 2))%Z).
    assert (k2 : (2 <= k)%Z) by (unfold k; nia). assert (q0 : (0 < Zpos g * k)%Z) by lia.
    destruct (times_over_ok g X V) as [p1 p2]. set (p := times_over g X V) in *. clearbody p.
    pose proof (Z.mul_div_le p k ltac:(lia)) as u1. pose proof (Z.mul_succ_div_gt p k ltac:(lia)) as u2. set (u := (p / k)%Z) in *. clearbody u k V t.
    assert (lo : (u * (Zpos g * k) <= X * V)%Z) by (apply Z.le_trans with (2 := p1); replace (u * (Zpos g * k))%Z with (k * u * Zpos g)%Z by ring; apply Z.mul_le_mono_nonneg_r; lia).
    assert (hi : (X * V <= (u + 2) * (Zpos g * k))%Z)
      by (apply Z.le_trans with (1 := p2); replace ((u + 2) * (Zpos g * k))%Z with (k * (u + 2) * Zpos g)%Z by ring; apply Z.mul_le_mono_nonneg_r; lia).
    apply IZR_le in lo, hi. rewrite (mult_IZR X) in lo. rewrite (mult_IZR (u + 2)), plus_IZR in hi.
    rewrite !mult_IZR in lo, hi. rewrite minus_IZR. apply IZR_le in k2. set (G := IZR (Zpos g)) in *. set (K := IZR k) in *. set (Y := IZR X) in *. set (W := IZR V) in *.
    destruct ih as [[t0 t1] hV]. apply within in hX, hV.
    assert (v : 0 <= x / K * t <= 1).
    { replace (x / K * t) with (x * t / K) by (field; lra). split; [apply Rmult_le_pos; [nra|left; apply Rinv_0_lt_compat; lra]|].
      apply Rmult_le_reg_r with K; [lra|]. replace (x * t / K * K) with (x * t) by (field; lra). nra. }
    split; [lra|]. replace ((1 - x / K * t) * G - (G - IZR u)) with (IZR u - x / K * t * G) by ring.
    assert (e : x / K * t * G * (G * K) = (x * G) * (t * G)) by (field; lra).
    assert (d : Rabs (Y * W - (x * G) * (t * G)) <= 4 * G).
    { replace (Y * W - (x * G) * (t * G)) with ((Y - x * G) * W + (x * G) * (W - t * G)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult (Y - x * G)), (Rabs_mult (x * G)).
      assert (tG : 0 <= t * G <= G) by (split; [apply Rmult_le_pos|replace G with (1 * G) at 2 by ring; apply Rmult_le_compat_r]; lra).
      assert (xG : 0 <= x * G <= G / 4) by (split; [apply Rmult_le_pos|replace (G / 4) with (/ 4 * G) by field; apply Rmult_le_compat_r]; lra).
      assert (Rabs (Y - x * G) <= 2) by (apply Rabs_le; lra). assert (Rabs W <= G + 4) by (apply Rabs_le; lra).
      assert (Rabs (x * G) <= G / 4) by (apply Rabs_le; lra). assert (Rabs (W - t * G) <= 4) by (apply Rabs_le; lra).
      pose proof (Rabs_pos (Y - x * G)). pose proof (Rabs_pos W). pose proof (Rabs_pos (x * G)). pose proof (Rabs_pos (W - t * G)).
      assert (Rabs (Y - x * G) * Rabs W <= 2 * (G + 4)) by (apply Rmult_le_compat; lra).
      assert (Rabs (x * G) * Rabs (W - t * G) <= G / 4 * 4) by (apply Rmult_le_compat; lra). lra. }
    apply within in d. assert (GK : 2 * G <= G * K) by nra. set (z := x / K * t * G) in *. clearbody z.
    apply Rabs_le. split; apply Rmult_le_reg_r with (G * K); nra.
Qed.

(* --- Sine, cosine, and how far both may be off, in 1/g --- *)
Definition near_circle := (Z * Z * Z)%type.
Definition encloses (g : positive) (c : near_circle) (si co : R) := let '(s, c, e) := c in
  Rabs (si * IZR (Zpos g) - IZR s) <= IZR e /\ Rabs (co * IZR (Zpos g) - IZR c) <= IZR e.

(* So many terms of the series are enough. *)
Definition apt (g : positive) (m : nat) := exists n, m = (2 * n + 1)%nat /\ 8 <= IZR (Zpos g) /\
  forall j, (0 <= j <= 1)%Z -> IZR (Zpos g) <= 4 ^ S m * IZR (product j (S m)).
Definition terms (g : positive) : nat := if Pos.eqb g coarse then 9 else 25.
Lemma known_apt g : g = coarse \/ g = grain -> apt g (terms g).
Proof.
  assert (k : forall g m, (8 <= Zpos g)%Z -> (Zpos g <= 4 ^ Z.of_nat (S m) * product 0 (S m))%Z -> (Zpos g <= 4 ^ Z.of_nat (S m) * product 1 (S m))%Z ->
    8 <= IZR (Zpos g) /\ forall j, (0 <= j <= 1)%Z -> IZR (Zpos g) <= 4 ^ S m * IZR (product j (S m))).
  { intros d m h8 h0 h1. split; [now apply IZR_le|]. intros j hj. replace (4 ^ S m) with (IZR (4 ^ Z.of_nat (S m))) by (symmetry; apply pow_IZR).
    rewrite <- mult_IZR. apply IZR_le. assert (e : j = 0%Z \/ j = 1%Z) by lia. destruct e; subst; assumption. }
  intros [e|e]; subst g; [exists 4%nat|exists 12%nat]; (split; [reflexivity|]); apply k; vm_compute; discriminate.
Qed.

Definition of_small (g : positive) (a : Q) : near_circle :=
  let l := down g a in let x := over g (l * l) in let m := terms g in
  (over g (l * series g x 1 m), series g x 0 m, 8)%Z.

Lemma of_small_ok g a : apt g (terms g) -> 0 <= Q2R a <= / 2 -> encloses g (of_small g a) (sin (Q2R a)) (cos (Q2R a)).
Proof.
  intros [n [em [g8 rest]]] ha. unfold of_small. rewrite !over_ok. pose proof (down_ok g a) as l1. pose proof (up_ok g a) as h1.
  assert (l2 : IZR (Zpos g) * Q2R a <= IZR (down g a) + 1).
  { unfold down. destruct (Pos.eqb_spec (Qden a) g) as [e|_].
    - unfold Q2R. rewrite e. assert (0 < IZR (Zpos g)) by lra. replace (IZR (Zpos g) * (IZR (Qnum a) * / IZR (Zpos g))) with (IZR (Qnum a)) by (field; lra). lra.
    - pose proof (div_high (Qnum a * Zpos g) (Zpos (Qden a)) eq_refl) as h. rewrite mult_IZR in h. unfold Q2R.
      assert (0 < IZR (Zpos (Qden a))) by (apply IZR_lt; reflexivity). apply Rmult_le_reg_r with (IZR (Zpos (Qden a))); [assumption|].
      replace (IZR (Zpos g) * (IZR (Qnum a) * / IZR (Zpos (Qden a))) * IZR (Zpos (Qden a))) with (IZR (Qnum a) * IZR (Zpos g)) by (field; lra). assumption. }
  clear h1. set (l := down g a) in *. clearbody l. set (x := Q2R a) in *. rewrite em.
  assert (gp : (0 < Zpos g)%Z) by reflexivity. set (X := (l * l / Zpos g)%Z).
  pose proof (div_low (l * l) (Zpos g) gp) as x1. pose proof (div_high (l * l) (Zpos g) gp) as x2. fold X in x1, x2. rewrite mult_IZR in x1, x2.
  set (G := IZR (Zpos g)) in *. set (L := IZR l) in *.
  assert (xx : 0 <= x * x <= / 4) by nra.
  assert (hX : Rabs (x * x * G - IZR X) <= 2).
  { assert (e : x * x * G * G = (G * x) * (G * x)) by ring. assert (0 <= G * x <= G / 2) by nra. apply Rabs_le. split; apply Rmult_le_reg_r with G; nra. }
  destruct (series_ok g X (x * x) g8 xx hX (2 * n + 1) 1 ltac:(lia)) as [s0 s1]. destruct (series_ok g X (x * x) g8 xx hX (2 * n + 1) 0 ltac:(lia)) as [_ c1].
  pose proof (tail_next (x * x) (2 * n + 1) (proj1 xx) 1 ltac:(lia)) as ns. pose proof (tail_next (x * x) (2 * n + 1) (proj1 xx) 0 ltac:(lia)) as nc.
  assert (small : (x * x) ^ S (2 * n + 1) * 4 ^ S (2 * n + 1) <= 1).
  { rewrite <- Rpow_mult_distr. rewrite <- (pow1 (S (2 * n + 1))). apply pow_incr. nra. }
  assert (step : forall j, (0 <= j <= 1)%Z -> Rabs (tail (x * x) j (S (2 * n + 1)) - tail (x * x) j (2 * n + 1)) * IZR (product j (S (2 * n + 1))) <= (x * x) ^ S (2 * n + 1) ->
    Rabs (tail (x * x) j (S (2 * n + 1)) - tail (x * x) j (2 * n + 1)) * G <= 1).
  { intros j hj h. specialize (rest j hj). rewrite em in rest. set (dd := Rabs (tail (x * x) j (S (2 * n + 1)) - tail (x * x) j (2 * n + 1))) in *. assert (d0 : 0 <= dd) by apply Rabs_pos.
    assert (p4 : 0 < 4 ^ S (2 * n + 1)) by (apply pow_lt; lra). apply Rle_trans with (2 := small).
    apply Rle_trans with (dd * (4 ^ S (2 * n + 1) * IZR (product j (S (2 * n + 1))))); [now apply Rmult_le_compat_l|].
    replace (dd * (4 ^ S (2 * n + 1) * IZR (product j (S (2 * n + 1))))) with (dd * IZR (product j (S (2 * n + 1))) * 4 ^ S (2 * n + 1)) by ring.
    apply Rmult_le_compat_r; lra. }
  apply (step 1%Z ltac:(lia)) in ns. apply (step 0%Z ltac:(lia)) in nc. clear step small rest. pose proof PI2_3_2.
  destruct (sin_bound x n) as [b1 b2]; [lra|lra|]. destruct (cos_bound x n) as [d1 d2]; [lra|lra|].
  rewrite sin_tail in b1, b2. rewrite cos_tail in d1, d2. replace (2 * (n + 1))%nat with (S (2 * n + 1)) in b2, d2 by lia.
  set (t1 := tail (x * x) 1 (2 * n + 1)) in *. set (t2 := tail (x * x) 1 (S (2 * n + 1))) in *. set (t3 := tail (x * x) 0 (2 * n + 1)) in *. set (t4 := tail (x * x) 0 (S (2 * n + 1))) in *.
  set (S1 := series g X 1 (2 * n + 1)) in *. set (C1 := series g X 0 (2 * n + 1)) in *. clearbody t1 t2 t3 t4 S1 C1 X.
  pose proof (div_low (l * S1) (Zpos g) gp) as q1. pose proof (div_high (l * S1) (Zpos g) gp) as q2. set (s := (l * S1 / Zpos g)%Z) in *. clearbody s.
  rewrite mult_IZR in q1, q2. fold G in q1, q2. fold L in q1, q2. set (Y := IZR S1) in *. set (Z1 := IZR C1) in *. unfold encloses. fold G. fold Z1.
  fold G in s1, c1. apply within in s1, c1. assert (ns' : t2 * G <= t1 * G + 1) by (unfold Rabs in ns; destruct (Rcase_abs (t2 - t1)); nra).
  assert (nc' : t4 * G <= t3 * G + 1) by (unfold Rabs in nc; destruct (Rcase_abs (t4 - t3)); nra). clear ns nc.
  assert (w : Rabs (L * Y - (G * x) * (t1 * G)) <= 5 * G).
  { replace (L * Y - (G * x) * (t1 * G)) with ((L - G * x) * Y + (G * x) * (Y - t1 * G)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult (L - G * x)), (Rabs_mult (G * x)).
    assert (tG : 0 <= t1 * G <= G) by (split; [apply Rmult_le_pos|replace G with (1 * G) at 2 by ring; apply Rmult_le_compat_r]; lra).
    assert (xG : 0 <= G * x <= G / 2) by (split; [apply Rmult_le_pos|unfold Rdiv; apply Rmult_le_compat_l]; lra).
    assert (Rabs (L - G * x) <= 1) by (apply Rabs_le; lra). assert (Rabs Y <= G + 4) by (apply Rabs_le; lra).
    assert (Rabs (G * x) <= G / 2) by (apply Rabs_le; lra). assert (Rabs (Y - t1 * G) <= 4) by (apply Rabs_le; lra).
    pose proof (Rabs_pos (L - G * x)). pose proof (Rabs_pos Y). pose proof (Rabs_pos (G * x)). pose proof (Rabs_pos (Y - t1 * G)).
    assert (Rabs (L - G * x) * Rabs Y <= 1 * (G + 4)) by (apply Rmult_le_compat; lra).
    assert (Rabs (G * x) * Rabs (Y - t1 * G) <= G / 2 * 4) by (apply Rmult_le_compat; lra). lra. }
  apply within in w.
  split; apply Rabs_le.
  - assert (sin_low : x * t1 * G <= sin x * G) by nra. assert (sin_high : sin x * G <= x * t1 * G + 1) by nra.
    assert (e : (G * x) * (t1 * G) = (x * t1 * G) * G) by ring. rewrite e in w. set (z := x * t1 * G) in *. clearbody z.
    assert (z - 6 <= IZR s) by (apply Rmult_le_reg_r with G; lra). assert (IZR s <= z + 5) by (apply Rmult_le_reg_r with G; lra). lra.
  - assert (t3 * G <= cos x * G) by (apply Rmult_le_compat_r; lra). assert (cos x * G <= t4 * G) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Definition doubled (g : positive) (x : near_circle) : near_circle := let '(s, c, e) := x in
  (over g (Z.double s * c), over g (Z.double c * c) - Zpos g, 5 * e + 1)%Z.

Lemma product_near G a b u v e : 0 < G -> 0 <= e -> 2 * e <= G -> Rabs u <= G -> Rabs v <= G -> Rabs (u - a) <= e -> Rabs (v - b) <= e ->
  Rabs (2 * (u * v) - 2 * (a * b)) <= 5 * e * G.
Proof.
  intros G0 e0 eG hu hv ha hb. replace (2 * (u * v) - 2 * (a * b)) with (2 * (u * (v - b)) + 2 * (b * (u - a))) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. rewrite (Rabs_right 2) by lra.
  assert (hb' : Rabs b <= G + e).
  { replace b with (v - (v - b)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  assert (Rabs u * Rabs (v - b) <= G * e) by (apply Rmult_le_compat; auto using Rabs_pos).
  assert (Rabs b * Rabs (u - a) <= (G + e) * e) by (apply Rmult_le_compat; auto using Rabs_pos). nra.
Qed.
Lemma rounded_near p G e n : 0 < G -> Rabs (p * G - IZR n) <= 5 * e * G -> forall r, IZR r * G <= IZR n -> IZR n <= (IZR r + 1) * G -> Rabs (p - IZR r) <= 5 * e + 1.
Proof.
  intros G0 h r h1 h2. apply Rabs_le. unfold Rabs in h. destruct (Rcase_abs (p * G - IZR n)); split; apply Rmult_le_reg_r with G; try assumption; nra.
Qed.
Lemma doubled_ok g x a : encloses g x (sin a) (cos a) -> (2 * snd x <= Zpos g)%Z -> encloses g (doubled g x) (sin (2 * a)) (cos (2 * a)).
Proof.
  destruct x as [[s c] e]. unfold encloses, doubled. cbn [snd]. rewrite !over_ok.
  assert (twice : forall u v, (Z.double u * v = 2 * (u * v))%Z) by (intros u v; rewrite Z.double_spec; lia). rewrite !twice. clear twice. intros [hs hc] he. apply IZR_le in he. rewrite mult_IZR in he.
  assert (gp : (0 < Zpos g)%Z) by reflexivity. assert (G0 : 0 < IZR (Zpos g)) by (apply IZR_lt; reflexivity).
  pose proof (div_low (2 * (s * c)) (Zpos g) gp) as q1. pose proof (div_high (2 * (s * c)) (Zpos g) gp) as q2.
  pose proof (div_low (2 * (c * c)) (Zpos g) gp) as q3. pose proof (div_high (2 * (c * c)) (Zpos g) gp) as q4.
  rewrite plus_IZR, mult_IZR, minus_IZR. set (G := IZR (Zpos g)) in *.
  assert (e0 : 0 <= IZR e) by (apply Rle_trans with (2 := hs); apply Rabs_pos).
  assert (us : Rabs (sin a * G) <= G).
  { rewrite Rabs_mult, (Rabs_right G) by lra. pose proof (SIN_bound a). assert (Rabs (sin a) <= 1) by (apply Rabs_le; lra). nra. }
  assert (uc : Rabs (cos a * G) <= G).
  { rewrite Rabs_mult, (Rabs_right G) by lra. pose proof (COS_bound a). assert (Rabs (cos a) <= 1) by (apply Rabs_le; lra). nra. }
  rewrite sin_2a, cos_2a_cos. split.
  - apply (rounded_near _ G _ (2 * (s * c))); try assumption. rewrite !mult_IZR.
    replace (2 * sin a * cos a * G * G) with (2 * ((sin a * G) * (cos a * G))) by ring. now apply product_near.
  - replace ((2 * cos a * cos a - 1) * G - (IZR (2 * (c * c) / Zpos g) - G)) with (2 * cos a * cos a * G - IZR (2 * (c * c) / Zpos g)) by ring.
    apply (rounded_near _ G _ (2 * (c * c))); try assumption. rewrite !mult_IZR.
    replace (2 * cos a * cos a * G * G) with (2 * ((cos a * G) * (cos a * G))) by ring. now apply product_near.
Qed.

(* Angles >= 0 that k halvings make small. *)
Definition is_small (a : Q) : bool := Z.leb (Z.double (Qnum a)) (Zpos (Qden a)).   (* up to 1/2 *)
Fixpoint halved (g : positive) (k : nat) (a : Q) : option near_circle :=
  if is_small a then Some (of_small g a)
  else match k with
    | O => None
    | S k => match halved g k (Qmake (Qnum a) (xO (Qden a))) with
        | Some x => if Z.leb (2 * snd x) (Zpos g) then Some (doubled g x) else None
        | None => None
        end
    end.
Definition circle (g : positive) (a : Q) : option near_circle :=
  if qle 0 a then halved g 20 a
  else match halved g 20 (qopp a) with Some (s, c, e) => Some (- s, c, e)%Z | None => None end.

Lemma halved_ok g k : apt g (terms g) -> forall a x, 0 <= Q2R a -> halved g k a = Some x -> encloses g x (sin (Q2R a)) (cos (Q2R a)).
Proof.
  intro ap. assert (small : forall a, is_small a = true -> 0 <= Q2R a -> encloses g (of_small g a) (sin (Q2R a)) (cos (Q2R a))).
  { intros a h a0. apply of_small_ok; [assumption|]. split; [assumption|]. unfold is_small in h. rewrite Z.double_spec in h. apply Z.leb_le, IZR_le in h. rewrite mult_IZR in h.
    assert (0 < IZR (Zpos (Qden a))) by (apply IZR_lt; reflexivity). unfold Q2R. apply Rmult_le_reg_r with (IZR (Zpos (Qden a))); [assumption|].
    replace (IZR (Qnum a) * / IZR (Zpos (Qden a)) * IZR (Zpos (Qden a))) with (IZR (Qnum a)) by (field; lra). lra. }
  induction k as [|k ih]; intros a x a0 h; cbn [halved] in h; destruct (is_small a) eqn:e.
  - injection h as h. subst. now apply small.
  - discriminate.
  - injection h as h. subst. now apply small.
  - destruct (halved g k (Qmake (Qnum a) (xO (Qden a)))) as [y|] eqn:f; [|discriminate].
    assert (half : Q2R a = 2 * Q2R (Qmake (Qnum a) (xO (Qden a)))).
    { rewrite <- Q2R_2, <- Q2R_mul. apply Qeq_eqR. unfold Qeq, qmul; cbn [Qnum Qden]. rewrite Pos2Z.inj_mul, (Pos2Z.inj_xO (Qden a)). ring. }
    destruct (Z.leb_spec (2 * snd y) (Zpos g)) as [l|]; [|discriminate]. injection h as h. subst. rewrite half.
    apply doubled_ok; [|assumption]. apply ih; [lra|assumption].
Qed.
Lemma circle_ok g a x : apt g (terms g) -> circle g a = Some x -> encloses g x (sin (Q2R a)) (cos (Q2R a)).
Proof.
  unfold circle. intro ap. destruct (qle 0 a) eqn:e; intro h.
  - apply qle_R in e. rewrite Q2R_0 in e. now apply (halved_ok g 20 ap).
  - destruct (halved g 20 (qopp a)) as [[[s c] r]|] eqn:f; [|discriminate]. injection h as h. subst.
    assert (l : 0 <= Q2R (qopp a)).
    { rewrite Q2R_neg. assert (q : qlt a 0 = true) by (unfold qlt; now rewrite e). apply qlt_R in q. rewrite Q2R_0 in q. lra. }
    apply (halved_ok g 20 ap) in f; [|assumption]. rewrite Q2R_neg in f. destruct f as [f1 f2]. rewrite sin_neg in f1. rewrite cos_neg in f2.
    unfold encloses. rewrite opp_IZR. split; [|assumption]. rewrite <- Rabs_Ropp.
    replace (- (sin (Q2R a) * IZR (Zpos g) - - IZR s)) with (- sin (Q2R a) * IZR (Zpos g) - IZR s) by ring. assumption.
Qed.
