(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The number of sides of closed polygons above a point is odd or even, and stays so along every continuous path that
   does not meet them: the easy half of the Jordan curve theorem. It is all that a proof of unreachability needs. *)
Require Import Reals QArith Qreals List Bool Lra Psatz Classical.
From ExactVO Require Import Theorems Plane.
Import ListNotations.
Open Scope R_scope.

(* --- Comparisons as booleans --- *)
Lemma le_spec a b : le a b = true <-> a <= b.
Proof. unfold le. destruct (Rle_dec a b); split; intros; try discriminate; tauto. Qed.
Lemma le_eq a b c d : (a <= b <-> c <= d) -> le a b = le c d.
Proof. unfold le. destruct (Rle_dec a b), (Rle_dec c d); intros; tauto. Qed.
Lemma lt_eq a b c d : (a < b <-> c < d) -> lt a b = lt c d.
Proof. unfold lt. destruct (Rlt_dec a b), (Rlt_dec c d); intros; tauto. Qed.
Lemma qle_le a b : qle a b = le (Q2R a) (Q2R b).
Proof. apply eq_true_iff_eq. now rewrite qle_iff, le_spec. Qed.
Lemma qlt_lt a b : qlt a b = lt (Q2R a) (Q2R b).
Proof.
  apply eq_true_iff_eq. rewrite qlt_iff. unfold lt. destruct (Rlt_dec (Q2R a) (Q2R b)); split; intros; try discriminate; tauto.
Qed.

(* --- Parity in fractions: the side of a line by a cross product --- *)
Definition qcrosses (x a b : point) : bool :=
  let l := qle (fst a) (fst x) in let m := qle (fst b) (fst x) in
  xorb l m && (if l then qlt (pcross (psub b a) (psub x a)) 0 else qlt (pcross (psub a b) (psub x b)) 0).
Definition qodd (es : list edge) (x : point) : bool :=
  fold_right (fun e sum => xorb (qcrosses x (fst e) (snd e)) sum) false es.

Lemma side_of c d l y : 0 < d -> c = d * y - d * l -> (c < 0 <-> y < l).
Proof. intros; subst; split; intros; nra. Qed.
Lemma qcrosses_ok x a b : qcrosses x a b = crosses (real x) (real a) (real b).
Proof.
  unfold qcrosses, crosses. rewrite !qle_le. simpl.
  destruct (le (Q2R (fst a)) (Q2R (fst x))) eqn:h, (le (Q2R (fst b)) (Q2R (fst x))) eqn:k; simpl; try reflexivity;
  rewrite qlt_lt; apply lt_eq; unfold le in *; destruct (Rle_dec (Q2R (fst a)) (Q2R (fst x))), (Rle_dec (Q2R (fst b)) (Q2R (fst x))); try discriminate;
  rewrite Q2R_cross, !real_sub, Q2R_0; unfold cross, sub, line, real; simpl.
  - apply side_of with (Q2R (fst b) - Q2R (fst a)); [lra|field; lra].
  - apply side_of with (Q2R (fst a) - Q2R (fst b)); [lra|field; lra].
Qed.
Lemma qodd_ok es x : qodd es x = odd es (real x).
Proof. induction es as [|e es ih]; simpl; [reflexivity|]. now rewrite qcrosses_ok, ih. Qed.

(* --- Points off a side --- *)
Definition off (es : list edge) (x : vec) := forall e, In e es -> ~ on e x.
Definition side (a b x : vec) := exists s, 0 <= s <= 1 /\ x = mix s a b.

Lemma line_end a b : fst a <> fst b -> line a b (fst b) = snd b.
Proof. intros. unfold line. field. lra. Qed.

Lemma share_bounds u v : u <> 0 -> (0 <= v <= u \/ u <= v <= 0) -> 0 <= v / u <= 1.
Proof.
  intros u0 h. assert (e : v = v / u * u) by (field; assumption). destruct h as [h|h].
  - assert (0 < u) by lra. split; [apply Rmult_le_pos; [lra|left; now apply Rinv_0_lt_compat]|].
    apply Rmult_le_reg_r with u; lra.
  - assert (k : v / u = - v / - u) by (field; assumption). rewrite k. assert (0 < - u) by lra.
    split; [apply Rmult_le_pos; [lra|left; now apply Rinv_0_lt_compat]|]. apply Rmult_le_reg_r with (- u); [assumption|].
    replace (- v / - u * - u) with (- v) by (field; lra). lra.
Qed.

Lemma on_line a b x : fst a <> fst b -> snd x = line a b (fst x) ->
  (fst a <= fst x <= fst b \/ fst b <= fst x <= fst a) -> side a b x.
Proof.
  intros h e r. exists ((fst x - fst a) / (fst b - fst a)). split; [apply share_bounds; lra|].
  unfold mix, add, scale; destruct x as [x1 x2]; simpl in *. f_equal; [field; lra|rewrite e; unfold line; field; lra].
Qed.
Lemma on_upright a b x : fst a = fst x -> fst b = fst x -> (snd a <= snd x <= snd b \/ snd b <= snd x <= snd a) -> side a b x.
Proof.
  intros ha hb r. destruct (Req_dec (snd a) (snd b)) as [e|h].
  - exists 0. split; [lra|]. unfold mix, add, scale; destruct x as [x1 x2]; simpl in *. f_equal; lra.
  - exists ((snd x - snd a) / (snd b - snd a)). split; [apply share_bounds; lra|].
    unfold mix, add, scale; destruct x as [x1 x2]; simpl in *. f_equal; [rewrite ha, hb; field; lra|field; lra].
Qed.

(* --- On which side of a number, or of a line, does not change nearby --- *)
Lemma near_min d1 d2 x y : near (Rmin d1 d2) x y -> near d1 x y /\ near d2 x y.
Proof. intros [h1 h2]. pose proof (Rmin_l d1 d2). pose proof (Rmin_r d1 d2). unfold near. repeat split; lra. Qed.

Lemma side_stays c x : c <> fst x -> exists d, 0 < d /\ forall y, near d x y -> le c (fst y) = le c (fst x).
Proof.
  intros h. exists (Rabs (c - fst x)). split; [apply Rabs_pos_lt; lra|]. intros y [hy _]. apply le_eq.
  unfold Rabs in *. destruct (Rcase_abs (fst y - fst x)), (Rcase_abs (c - fst x)); split; lra.
Qed.

Lemma below_stays a b x : snd x <> line a b (fst x) ->
  exists d, 0 < d /\ forall y, near d x y -> lt (snd y) (line a b (fst y)) = lt (snd x) (line a b (fst x)).
Proof.
  intros h. set (k := (snd b - snd a) / (fst b - fst a)). set (g := Rabs (snd x - line a b (fst x))). set (m := 1 + Rabs k).
  assert (g0 : 0 < g) by (apply Rabs_pos_lt; lra). assert (m0 : 0 < m) by (pose proof (Rabs_pos k); unfold m; lra).
  exists (g / m). split; [apply Rmult_lt_0_compat; [assumption|now apply Rinv_0_lt_compat]|].
  intros y [h1 h2]. apply lt_eq.
  assert (e : line a b (fst y) - line a b (fst x) = k * (fst y - fst x)) by (unfold line, k; ring).
  assert (s : Rabs (snd y - snd x) + Rabs (k * (fst y - fst x)) < g).
  { rewrite Rabs_mult. assert (g = g / m * m) by (field; lra). pose proof (Rabs_pos k).
    assert (Rabs k * Rabs (fst y - fst x) <= Rabs k * (g / m)) by (apply Rmult_le_compat_l; lra). unfold m in *; nra. }
  rewrite <- e in s. clear e h1 h2. unfold g, Rabs in *.
  destruct (Rcase_abs (snd y - snd x)), (Rcase_abs (line a b (fst y) - line a b (fst x))), (Rcase_abs (snd x - line a b (fst x))); split; lra.
Qed.

(* --- The change of a crossing near x is a term of each end, and terms cancel round a closed polygon --- *)
Definition term (x y v : vec) : bool :=
  (if Req_EM_T (fst v) (fst x) then lt (snd x) (snd v) else false) && negb (le (fst x) (fst y)).

Lemma side_local a b x : ~ side a b x -> exists d, 0 < d /\ forall y, near d x y ->
  xorb (crosses y a b) (crosses x a b) = xorb (term x y a) (term x y b).
Proof.
  intros h. destruct (Req_dec (fst a) (fst b)) as [v|v].
  - exists 1. split; [lra|]. intros y _. unfold crosses. rewrite v, !xorb_nilpotent. simpl.
    unfold term. rewrite v. destruct (Req_EM_T (fst b) (fst x)) as [e|e]; [|reflexivity].
    assert (lt (snd x) (snd a) = lt (snd x) (snd b)) as ->.
    { apply lt_eq. destruct (Rlt_dec (snd x) (snd a)), (Rlt_dec (snd x) (snd b)); try tauto; exfalso; apply h, on_upright; lra. }
    now rewrite xorb_nilpotent.
  - assert (sx : snd x = line a b (fst x) -> (fst a <= fst x <= fst b \/ fst b <= fst x <= fst a) -> False) by (intros; apply h, on_line; auto).
    destruct (Req_dec (fst a) (fst x)) as [ea|na]; [|destruct (Req_dec (fst b) (fst x)) as [eb|nb]].
    + assert (la : line a b (fst x) = snd a) by (unfold line; rewrite ea; ring).
      destruct (below_stays a b x) as [d1 [p1 q1]]; [intro z; apply sx; [assumption|lra]|].
      destruct (side_stays (fst b) x) as [d2 [p2 q2]]; [lra|].
      exists (Rmin d1 d2). split; [now apply Rmin_glb_lt|]. intros y ny.
      destruct (near_min _ _ _ _ ny) as [n1 n2]. unfold crosses, term. rewrite (q1 y n1), (q2 y n2), la.
      destruct (Req_EM_T (fst a) (fst x)); [|lra]. destruct (Req_EM_T (fst b) (fst x)); [lra|].
      rewrite ea. rewrite (proj2 (le_spec (fst x) (fst x)) (Rle_refl _)).
      destruct (le (fst x) (fst y)), (le (fst b) (fst x)), (lt (snd x) (snd a)); reflexivity.
    + assert (lb : line a b (fst x) = snd b) by (rewrite <- eb; now apply line_end).
      destruct (below_stays a b x) as [d1 [p1 q1]]; [intro z; apply sx; [assumption|lra]|].
      destruct (side_stays (fst a) x) as [d2 [p2 q2]]; [lra|].
      exists (Rmin d1 d2). split; [now apply Rmin_glb_lt|]. intros y ny.
      destruct (near_min _ _ _ _ ny) as [n1 n2]. unfold crosses, term. rewrite (q1 y n1), (q2 y n2), lb.
      destruct (Req_EM_T (fst a) (fst x)); [lra|]. destruct (Req_EM_T (fst b) (fst x)); [|lra].
      rewrite eb. rewrite (proj2 (le_spec (fst x) (fst x)) (Rle_refl _)).
      destruct (le (fst x) (fst y)), (le (fst a) (fst x)), (lt (snd x) (snd b)); reflexivity.
    + destruct (side_stays (fst a) x) as [d1 [p1 q1]]; [lra|]. destruct (side_stays (fst b) x) as [d2 [p2 q2]]; [lra|].
      assert (t : forall y, xorb (term x y a) (term x y b) = false).
      { intro y. unfold term. destruct (Req_EM_T (fst a) (fst x)); [lra|]. destruct (Req_EM_T (fst b) (fst x)); [lra|reflexivity]. }
      destruct (xorb (le (fst a) (fst x)) (le (fst b) (fst x))) eqn:span.
      * destruct (below_stays a b x) as [d3 [p3 q3]].
        { intro z. apply sx; [assumption|]. unfold le in span.
          destruct (Rle_dec (fst a) (fst x)), (Rle_dec (fst b) (fst x)); try discriminate span; lra. }
        exists (Rmin d1 (Rmin d2 d3)). split; [now repeat apply Rmin_glb_lt|]. intros y ny.
        destruct (near_min _ _ _ _ ny) as [n1 n23]. destruct (near_min _ _ _ _ n23) as [n2 n3].
        rewrite t. unfold crosses. rewrite (q1 y n1), (q2 y n2), (q3 y n3). now rewrite xorb_nilpotent.
      * exists (Rmin d1 d2). split; [now apply Rmin_glb_lt|]. intros y ny. destruct (near_min _ _ _ _ ny) as [n1 n2].
        rewrite t. unfold crosses. now rewrite (q1 y n1), (q2 y n2), span.
Qed.

Definition ends (x y : vec) (es : list edge) : bool :=
  fold_right (fun e sum => xorb (xorb (term x y (real (fst e))) (term x y (real (snd e)))) sum) false es.

Lemma xorb_swap a b c d : xorb (xorb a b) (xorb c d) = xorb (xorb a c) (xorb b d).
Proof. destruct a, b, c, d; reflexivity. Qed.

Lemma odd_local es x : off es x -> exists d, 0 < d /\ forall y, near d x y -> xorb (odd es y) (odd es x) = ends x y es.
Proof.
  induction es as [|e es ih]; intro h; simpl.
  - exists 1. split; [lra|]. reflexivity.
  - destruct (side_local (real (fst e)) (real (snd e)) x) as [d1 [p1 q1]].
    { intro s. apply (h e (or_introl eq_refl)). destruct e. now apply on_mix. }
    destruct ih as [d2 [p2 q2]]; [intros f hf; apply h; now right|].
    exists (Rmin d1 d2). split; [now apply Rmin_glb_lt|]. intros y ny. destruct (near_min _ _ _ _ ny) as [n1 n2].
    rewrite <- (q1 y n1), <- (q2 y n2). apply xorb_swap.
Qed.

(* --- Closed polygons --- *)
Definition closed (es : list edge) := forall x y, ends x y es = false.

Lemma ends_app x y es fs : ends x y (es ++ fs) = xorb (ends x y es) (ends x y fs).
Proof. induction es as [|e es ih]; simpl; [now destruct (ends x y fs)|]. rewrite ih.
  destruct (term x y (real (fst e))), (term x y (real (snd e))), (ends x y es), (ends x y fs); reflexivity.
Qed.

Lemma ends_from x y z ps : forall a, ends x y (sides_from a (ps ++ [z])) = xorb (term x y (real a)) (term x y (real z)).
Proof.
  induction ps as [|b r ih]; intro a; simpl; [now destruct (term x y (real a)), (term x y (real z))|]. rewrite ih.
  destruct (term x y (real a)), (term x y (real b)), (term x y (real z)); reflexivity.
Qed.
Lemma ring_closed ps : closed (ring_sides ps).
Proof. intros x y. destruct ps as [|a r]; [reflexivity|]. simpl. rewrite ends_from. apply xorb_nilpotent. Qed.
Lemma rings_closed rs : closed (flat_map ring_sides rs).
Proof. intros x y. induction rs as [|r rs ih]; simpl; [reflexivity|]. rewrite ends_app, ih. now rewrite ring_closed. Qed.

(* A property of numbers that is decided alike nearby is decided alike on an interval. *)
Lemma constant (f : R -> bool) :
  (forall t, 0 <= t <= 1 -> exists d, 0 < d /\ forall s, 0 <= s <= 1 -> Rabs (s - t) < d -> f s = f t) -> f 0 = f 1.
Proof.
  intro h. set (e := fun t => 0 <= t <= 1 /\ forall s, 0 <= s <= t -> f s = f 0).
  assert (e0 : e 0) by (split; [lra|intros s hs; f_equal; lra]).
  destruct (completeness e) as [m [up least]].
  - exists 1. intros t [ht _]. lra.
  - now exists 0.
  - assert (m01 : 0 <= m <= 1).
    { split; [now apply up|]. apply least. intros t [ht _]. lra. }
    destruct (h m m01) as [d [d0 hd]].
    assert (exists t, e t /\ m - d < t) as [t [[ht et] tm]].
    { apply NNPP. intro no. assert (m <= m - d); [|lra]. apply least. intros t et.
      destruct (Rle_or_lt t (m - d)); [assumption|]. exfalso. apply no. now exists t. }
    assert (t <= m) by (apply up; now split).
    assert (fm : f m = f 0).
    { rewrite <- (hd t); [|lra|unfold Rabs; destruct (Rcase_abs (t - m)); lra]. apply et. lra. }
    destruct (Rle_or_lt 1 m); [replace 1 with m by lra; now symmetry|].
    set (q := Rmin 1 (m + d / 2)).
    assert (hq : m < q <= 1 /\ q <= m + d / 2) by (unfold q; pose proof (Rmin_l 1 (m + d / 2)); pose proof (Rmin_r 1 (m + d / 2));
      assert (m < Rmin 1 (m + d / 2)) by (apply Rmin_glb_lt; lra); lra).
    assert (eq : e q).
    { split; [lra|]. intros s hs. destruct (Rle_or_lt s t); [apply et; lra|].
      rewrite (hd s); [assumption|lra|unfold Rabs; destruct (Rcase_abs (s - m)); lra]. }
    apply up in eq. lra.
Qed.

Theorem odd_path es p : closed es -> continuous p -> (forall t, 0 <= t <= 1 -> off es (p t)) -> odd es (p 0) = odd es (p 1).
Proof.
  intros c k h. apply (constant (fun t => odd es (p t))). intros t ht.
  destruct (odd_local es (p t) (h t ht)) as [e [e0 he]]. destruct (k t ht e e0) as [d [d0 hd]].
  exists d. split; [assumption|]. intros s hs ds. specialize (he (p s) (hd s hs ds)). rewrite c in he.
  destruct (odd es (p s)), (odd es (p t)); simpl in he; congruence.
Qed.

Lemma mix_continuous a b : continuous (fun t => mix t a b).
Proof.
  intros t ht e e0. set (m := 1 + Rabs (fst b - fst a) + Rabs (snd b - snd a)).
  pose proof (Rabs_pos (fst b - fst a)). pose proof (Rabs_pos (snd b - snd a)).
  assert (m0 : 0 < m) by (unfold m; lra). exists (e / m). split; [apply Rmult_lt_0_compat; [assumption|now apply Rinv_0_lt_compat]|].
  intros s hs ds. assert (em : e = e / m * m) by (field; lra). assert (0 < e / m) by nra. pose proof (Rabs_pos (s - t)).
  unfold near, mix, add, scale; simpl. split.
  - replace ((1 - s) * fst a + s * fst b - ((1 - t) * fst a + t * fst b)) with ((s - t) * (fst b - fst a)) by ring.
    rewrite Rabs_mult. unfold m in *. nra.
  - replace ((1 - s) * snd a + s * snd b - ((1 - t) * snd a + t * snd b)) with ((s - t) * (snd b - snd a)) by ring.
    rewrite Rabs_mult. unfold m in *. nra.
Qed.
