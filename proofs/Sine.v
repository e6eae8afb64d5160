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

(* The unit of most: to divide by it is to shift, which the kernel too does fast. *)
Definition grain : positive := Pos.pow 2 256.
Definition over (g : positive) (p : Z) : Z := if Pos.eqb g grain then Z.shiftr p 256 else Z.div p (Zpos g).
Lemma over_ok g p : over g p = (p / Zpos g)%Z.
Proof.
  unfold over. destruct (Pos.eqb_spec g grain) as [e|_]; [|reflexivity]. rewrite e. unfold grain. rewrite Pos2Z.inj_pow. now apply Z.shiftr_div_pow2.
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

(* `low`, `high`: what x is between; whole numbers of 1/g, as the results are. *)
Fixpoint series (g : positive) (low high j : Z) (m : nat) : Z * Z :=
  match m with
  | O => (0, Zpos g)%Z
  | S m => let (l, h) := series g low high (j + 2) m in let k := ((j + 1) * (j + 2))%Z in
      (zmax 0 (Zpos g - (over g (high * h) / k + 1)), Zpos g - over g (low * l) / k)%Z
  end.

Lemma zmax_lub a b c : IZR a <= c -> IZR b <= c -> IZR (zmax a b) <= c.
Proof. unfold zmax. now destruct (Z.leb a b). Qed.
Definition between (g : positive) (l h : Z) (v : R) := 0 <= v <= 1 /\ IZR l <= v * IZR (Zpos g) <= IZR h.
Lemma series_step g low high l h k x t : (0 <= low)%Z -> (0 <= l)%Z -> (1 <= k)%Z -> between g low high x -> between g l h t ->
  between g (zmax 0 (Zpos g - (high * h / (Zpos g * k) + 1))) (Zpos g - low * l / (Zpos g * k)) (1 - x / IZR k * t).
Proof.
  intros low0 l0 k1 [[x0 x1] [xl xh]] [[t0 t1] [tl th]]. unfold between.
  set (p := (high * h)%Z). set (r := (low * l)%Z). set (q := (Zpos g * k)%Z). assert (q0 : (0 < q)%Z) by (unfold q; lia).
  pose proof (div_high p q q0) as up. pose proof (div_low r q q0) as down.
  assert (ep : IZR p = IZR high * IZR h) by (unfold p; apply mult_IZR). assert (er : IZR r = IZR low * IZR l) by (unfold r; apply mult_IZR).
  assert (eq : IZR q = IZR (Zpos g) * IZR k) by (unfold q; apply mult_IZR). set (u := (p / q)%Z) in *. set (w := (r / q)%Z) in *.
  clearbody p r q u w. rewrite ep, eq in up. rewrite er, eq in down. clear ep er eq q0.
  apply IZR_le in low0, l0, k1. rewrite minus_IZR. set (G := IZR (Zpos g)) in *. assert (G0 : 0 < G) by (apply IZR_lt; reflexivity).
  set (K := IZR k) in *. assert (xt : 0 <= x * t <= 1) by nra.
  assert (v : 0 <= x / K * t <= 1).
  { replace (x / K * t) with (x * t / K) by (field; lra). split; [apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]|].
    apply Rmult_le_reg_r with K; [lra|]. replace (x * t / K * K) with (x * t) by (field; lra). lra. }
  assert (v2 : x / K * t * G * (G * K) = (x * G) * (t * G)) by (field; lra).
  assert (GK : 0 < G * K) by nra.
  assert (hi : x / K * t * G <= IZR u + 1).
  { apply Rmult_le_reg_r with (G * K); [assumption|]. rewrite v2. apply Rle_trans with (2 := up). apply Rmult_le_compat; nra. }
  assert (lo : IZR w <= x / K * t * G).
  { apply Rmult_le_reg_r with (G * K); [assumption|]. rewrite v2. apply Rle_trans with (1 := down). apply Rmult_le_compat; lra. }
  split; [lra|]. split; [|nra]. apply zmax_lub; [nra|]. rewrite minus_IZR, plus_IZR. fold G. nra.
Qed.
Lemma series_ok g low high x : (0 <= low)%Z -> between g low high x -> forall m j, (0 <= j)%Z ->
  let (l, h) := series g low high j m in (0 <= l)%Z /\ between g l h (tail x j m) /\ between g l h (tail x j (S m)).
Proof.
  intros low0 hx. assert (G0 : 0 < IZR (Zpos g)) by (apply IZR_lt; reflexivity). induction m as [|m ih]; intros j j0.
  - simpl. split; [lia|]. split; [unfold between; lra|]. destruct hx as [[x0 x1] _].
    assert (k : 1 <= IZR ((j + 1) * (j + 2))) by (apply IZR_le; nia). set (K := IZR ((j + 1) * (j + 2))) in *.
    assert (v : 0 <= x / K <= 1).
    { split; [apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]|]. apply Rmult_le_reg_r with K; [lra|].
      replace (x / K * K) with x by (field; lra). lra. }
    unfold between. rewrite Rmult_1_r. nra.
  - specialize (ih (j + 2)%Z ltac:(lia)). change (tail x j (S m)) with (1 - x / IZR ((j + 1) * (j + 2)) * tail x (j + 2) m).
    change (tail x j (S (S m))) with (1 - x / IZR ((j + 1) * (j + 2)) * tail x (j + 2) (S m)). cbn [series].
    destruct (series g low high (j + 2) m) as [l h]. rewrite !over_ok, !Z.div_div by nia. destruct ih as [l0 [h1 h2]].
    split; [unfold zmax; destruct (Z.leb_spec 0 (Zpos g - (high * h / (Zpos g * ((j + 1) * (j + 2))) + 1))); lia|].
    split; apply series_step; try assumption; nia.
Qed.

(* --- Sine, cosine, and how far both may be off, in 1/g --- *)
Definition near_circle := (Z * Z * Z)%type.
Definition encloses (g : positive) (c : near_circle) (si co : R) := let '(s, c, e) := c in
  Rabs (si * IZR (Zpos g) - IZR s) <= IZR e /\ Rabs (co * IZR (Zpos g) - IZR c) <= IZR e.

Definition of_small (g : positive) (a : Q) : near_circle :=
  let l := down g a in let h := up g a in let low := over g (l * l) in let high := (over g (h * h) + 1)%Z in
  let (sl, sh) := series g low high 1 13 in let (cl, ch) := series g low high 0 13 in
  let s := over g (l * sl) in (s, cl, zmax (over g (h * sh) + 1 - s) (ch - cl))%Z.

Lemma of_small_ok g a : 0 <= Q2R a <= 1 -> encloses g (of_small g a) (sin (Q2R a)) (cos (Q2R a)).
Proof.
  intros ha. unfold of_small. rewrite !over_ok. pose proof (down_ok g a) as l1. pose proof (up_ok g a) as h1.
  assert (l0 : (0 <= down g a)%Z).
  { unfold down. assert (0 <= Qnum a)%Z.
    { apply le_IZR. assert (0 < IZR (Zpos (Qden a))) by (apply IZR_lt; reflexivity).
      replace (IZR (Qnum a)) with (Q2R a * IZR (Zpos (Qden a))) by (unfold Q2R; field; lra). nra. }
    destruct (Pos.eqb (Qden a) g); [assumption|]. apply Z.div_pos; lia. }
  set (l := down g a) in *. set (h := up g a) in *. clearbody l h. set (x := Q2R a) in *.
  assert (gp : (0 < Zpos g)%Z) by reflexivity. set (low := (l * l / Zpos g)%Z). set (high := (h * h / Zpos g + 1)%Z).
  assert (low0 : (0 <= low)%Z) by (apply Z.div_pos; nia).
  pose proof (div_low (l * l) (Zpos g) gp) as lowl. pose proof (div_high (h * h) (Zpos g) gp) as highh. fold low in lowl.
  assert (high' : IZR (h * h) <= IZR high * IZR (Zpos g)) by (unfold high; now rewrite plus_IZR). clear highh. clearbody low high.
  rewrite mult_IZR in lowl, high'. assert (l0' := l0). apply IZR_le in l0'.
  assert (G0 : 0 < IZR (Zpos g)) by (apply IZR_lt; reflexivity).
  assert (hx : between g low high (x * x)).
  { unfold between. set (G := IZR (Zpos g)) in *. split; [nra|].
    assert (e : x * x * G * G = (G * x) * (G * x)) by ring.
    split; apply Rmult_le_reg_r with G; try assumption; rewrite e.
    - apply Rle_trans with (1 := lowl). apply Rmult_le_compat; assumption.
    - apply Rle_trans with (2 := high'). apply Rmult_le_compat; nra. }
  pose proof (series_ok g low high (x * x) low0 hx 13 1 ltac:(lia)) as hs.
  pose proof (series_ok g low high (x * x) low0 hx 13 0 ltac:(lia)) as hc.
  destruct (series g low high 1 13) as [sl sh]. destruct (series g low high 0 13) as [cl ch]. cbv zeta. rewrite !over_ok.
  destruct hs as [sl0 [[_ s1] [_ s2]]]. destruct hc as [cl0 [[_ c1] [_ c2]]]. pose proof PI2_3_2.
  destruct (sin_bound x 6) as [b1 b2]; [lra|lra|]. destruct (cos_bound x 6) as [d1 d2]; [lra|lra|].
  rewrite sin_tail in b1, b2. rewrite cos_tail in d1, d2. cbn [Nat.mul Nat.add] in b1, b2, d1, d2.
  set (t1 := tail (x * x) 1 13) in *. set (t2 := tail (x * x) 1 14) in *. set (t3 := tail (x * x) 0 13) in *. set (t4 := tail (x * x) 0 14) in *.
  clearbody t1 t2 t3 t4. set (s := (l * sl / Zpos g)%Z).
  pose proof (div_low (l * sl) (Zpos g) gp) as q1. pose proof (div_high (h * sh) (Zpos g) gp) as q2. fold s in q1.
  rewrite mult_IZR in q1, q2. apply IZR_le in sl0. set (G := IZR (Zpos g)) in *.
  destruct (zmax_le (h * sh / Zpos g + 1 - s) (ch - cl)) as [z1 z2]. rewrite minus_IZR in z1, z2. rewrite plus_IZR in z1.
  set (u := (h * sh / Zpos g)%Z) in *. clearbody s u. unfold encloses. fold G.
  assert (sin_low : IZR s <= sin x * G).
  { apply Rmult_le_reg_r with G; [assumption|]. apply Rle_trans with (1 := q1).
    apply Rle_trans with ((G * x) * (t1 * G)); [apply Rmult_le_compat; lra|]. nra. }
  assert (sin_high : sin x * G <= IZR u + 1).
  { apply Rmult_le_reg_r with G; [assumption|]. apply Rle_trans with (2 := q2).
    apply Rle_trans with ((G * x) * (t2 * G)); [nra|]. apply Rmult_le_compat; try lra; nra. }
  split; apply Rabs_le; split; nra.
Qed.

Definition doubled (g : positive) (x : near_circle) : near_circle := let '(s, c, e) := x in
  (over g (2 * (s * c)), over g (2 * (c * c)) - Zpos g, 5 * e + 1)%Z.

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
  destruct x as [[s c] e]. unfold encloses, doubled. cbn [snd]. rewrite !over_ok. intros [hs hc] he. apply IZR_le in he. rewrite mult_IZR in he.
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
Fixpoint halved (g : positive) (k : nat) (a : Q) : option near_circle :=
  if qle a (1 # 256) then Some (of_small g a)
  else match k with
    | O => None
    | S k => match halved g k (Qmake (Qnum a) (2 * Qden a)) with
        | Some x => if Z.leb (2 * snd x) (Zpos g) then Some (doubled g x) else None
        | None => None
        end
    end.
Definition circle (g : positive) (a : Q) : option near_circle :=
  if qle 0 a then halved g 20 a
  else match halved g 20 (qopp a) with Some (s, c, e) => Some (- s, c, e)%Z | None => None end.

Lemma halved_ok g k : forall a x, 0 <= Q2R a -> halved g k a = Some x -> encloses g x (sin (Q2R a)) (cos (Q2R a)).
Proof.
  assert (small : forall a, qle a (1 # 256) = true -> 0 <= Q2R a -> encloses g (of_small g a) (sin (Q2R a)) (cos (Q2R a))).
  { intros a h a0. apply qle_R in h. apply of_small_ok. unfold Q2R at 2 in h; simpl in h. lra. }
  induction k as [|k ih]; intros a x a0 h; cbn [halved] in h; destruct (qle a (1 # 256)) eqn:e.
  - injection h as h. subst. now apply small.
  - discriminate.
  - injection h as h. subst. now apply small.
  - destruct (halved g k (Qmake (Qnum a) (2 * Qden a))) as [y|] eqn:f; [|discriminate].
    assert (half : Q2R a = 2 * Q2R (Qmake (Qnum a) (2 * Qden a))).
    { rewrite <- Q2R_2, <- Q2R_mul. apply Qeq_eqR. unfold Qeq, qmul; cbn [Qnum Qden]. rewrite !Pos2Z.inj_mul. ring. }
    destruct (Z.leb_spec (2 * snd y) (Zpos g)) as [l|]; [|discriminate]. injection h as h. subst. rewrite half.
    apply doubled_ok; [|assumption]. apply ih; [lra|assumption].
Qed.
Lemma circle_ok g a x : circle g a = Some x -> encloses g x (sin (Q2R a)) (cos (Q2R a)).
Proof.
  unfold circle. destruct (qle 0 a) eqn:e; intro h.
  - apply qle_R in e. rewrite Q2R_0 in e. now apply (halved_ok g 20).
  - destruct (halved g 20 (qopp a)) as [[[s c] r]|] eqn:f; [|discriminate]. injection h as h. subst.
    assert (l : 0 <= Q2R (qopp a)).
    { rewrite Q2R_neg. assert (q : qlt a 0 = true) by (unfold qlt; now rewrite e). apply qlt_R in q. rewrite Q2R_0 in q. lra. }
    apply halved_ok in f; [|assumption]. rewrite Q2R_neg in f. destruct f as [f1 f2]. rewrite sin_neg in f1. rewrite cos_neg in f2.
    unfold encloses. rewrite opp_IZR. split; [|assumption]. rewrite <- Rabs_Ropp.
    replace (- (sin (Q2R a) * IZR (Zpos g) - - IZR s)) with (- sin (Q2R a) * IZR (Zpos g) - IZR s) by ring. assumption.
Qed.
