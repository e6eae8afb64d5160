(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Robots with an acceleration that can brake: while one brakes it stays on its way [x, x + tau v], and all robots are at
   the same share of theirs, so that one step from x to x + tau v says it all. *)
Require Import Reals QArith Qreals List Bool Lra Psatz Lia.
From ExactVO Require Import Theorems Plane Step.
Import ListNotations.
Open Scope R_scope.

Definition along (p : point) (t : Q) (v : point) : point := (qadd (fst p) (qmul t (fst v)), qadd (snd p) (qmul t (snd v))).
(* The same point over the denominator of a product: sums with products are cheap then. *)
Definition over_product (t : Q) (p : point) : point := let one := Qmake (Zpos (Qden t)) (Qden t) in (qmul one (fst p), qmul one (snd p)).
Definition way_of_braking (tau : Q) (d : driver) : motion :=
  let x := over_product tau (now_at d) in {| from := x; to := along x tau (chosen d); size := its_radius d |}.
Definition at_most_length (l : Q) (v : point) : bool := qle 0 l && qle (pdot v v) (qmul l l).
Definition brakes (os : list obstacle) (poles : list pole) (step tau : Q) (ds : list driver) : bool :=
  qlt 0 step && qle step tau
  && forallb (fun d => at_most_length (qmul (its_most d) step) (psub (chosen d) (had d)) && at_most_length (qmul (its_most d) tau) (chosen d)) ds
  && Step.step os (map (fun c => {| from := fst c; to := fst c; size := snd c |}) poles) (map (way_of_braking tau) ds).

Lemma Q2R_one_over d : Q2R (Qmake (Zpos d) d) = 1.
Proof. rewrite <- Q2R_1. apply Qeq_eqR. unfold Qeq; simpl. lia. Qed.
Lemma over_product_ok t p : real (over_product t p) = real p.
Proof. destruct p as [x y]. unfold real, over_product; simpl. now rewrite !Q2R_mul, Q2R_one_over, !Rmult_1_l. Qed.
Lemma way_starts tau d : real (from (way_of_braking tau d)) = real (now_at d).
Proof. apply over_product_ok. Qed.
Lemma way_ends tau d : real (to (way_of_braking tau d)) = add (real (now_at d)) (scale (Q2R tau) (real (chosen d))).
Proof.
  unfold way_of_braking, along, over_product, real, add, scale; simpl. now rewrite !Q2R_add, !Q2R_mul, Q2R_one_over, !Rmult_1_l.
Qed.

(* The share of its way of braking that a robot has behind it at share s of step n. *)
Definition behind (keep : R) (n : nat) (s : R) := 1 - keep ^ n * (1 - s * (1 - keep)).

Lemma behind_within keep n s : 0 <= keep <= 1 -> 0 <= s <= 1 -> 0 <= behind keep n s <= 1.
Proof.
  intros hk hs. unfold behind. assert (p : 0 <= keep ^ n <= 1).
  { split; [apply pow_le; lra|]. rewrite <- (pow1 n). apply pow_incr. lra. }
  assert (q : 0 <= 1 - s * (1 - keep) <= 1) by (split; nra). split; nra.
Qed.

Lemma velocity_left step tau d n : snd (braked step tau d n) = scale ((1 - step / tau) ^ n) (real (chosen d)).
Proof.
  induction n as [|n ih]; simpl.
  - unfold scale. destruct (real (chosen d)). simpl. f_equal; ring.
  - destruct (braked step tau d n) as [x v]; simpl in *. rewrite ih. unfold scale; simpl. f_equal; ring.
Qed.

Lemma place_of_braking step tau d n : 0 < tau ->
  fst (braked step tau d n) = add (real (now_at d)) (scale (tau * (1 - (1 - step / tau) ^ n)) (real (chosen d))).
Proof.
  intro h. induction n as [|n ih]; simpl.
  - unfold add, scale. destruct (real (now_at d)), (real (chosen d)); simpl. f_equal; ring.
  - pose proof (velocity_left step tau d n) as hv. destruct (braked step tau d n) as [x v]; simpl in *. rewrite ih, hv.
    unfold add, scale; simpl. f_equal; field; lra.
Qed.

Lemma while_braking_ok step tau d n s : 0 < Q2R tau -> 
  while_braking step (Q2R tau) d n s = place (way_of_braking tau d) (behind (1 - step / Q2R tau) n s).
Proof.
  intro h. unfold while_braking. rewrite (surjective_pairing (braked step (Q2R tau) d n)), (place_of_braking _ _ _ _ h), velocity_left.
  unfold place. rewrite way_starts, way_ends. unfold behind, mix, add, scale; simpl. f_equal; field; lra.
Qed.

Lemma at_most_length_ok l v : at_most_length l v = true -> no_longer (Q2R l) (real v).
Proof. unfold at_most_length, no_longer. intro h. apply andb_true_iff in h; destruct h as [_ h]. apply qle_R in h. now rewrite Q2R_dot, Q2R_mul in h. Qed.

Lemma shrinks keep n x y r : 0 <= keep <= 1 -> x * x + y * y <= r * r -> 
  (keep ^ n * x) * (keep ^ n * x) + (keep ^ n * y) * (keep ^ n * y) <= r * r.
Proof.
  intros hk h. assert (p : 0 <= keep ^ n <= 1).
  { split; [apply pow_le; lra|]. rewrite <- (pow1 n). apply pow_incr. lra. }
  set (k := keep ^ n) in *. replace (k * x * (k * x) + k * y * (k * y)) with (k * k * (x * x + y * y)) by ring.
  assert (0 <= k * k <= 1) by (split; nra). assert (0 <= x * x + y * y) by nra. nra.
Qed.

Lemma mix_same s a : mix s a a = a.
Proof. destruct a; unfold mix, add, scale; simpl. f_equal; ring. Qed.
Lemma apart_symmetric r q x y : apart (r + q) x y -> apart (q + r) y x.
Proof. rewrite Rplus_comm. apply apart_sym. Qed.

Theorem brakes_sound os poles step tau ds : brakes os poles step tau ds = true -> (forall d, In d ds -> outside os (real (now_at d))) ->
  can_brake os poles step tau ds.
Proof.
  unfold brakes. intros h start. apply andb_true_iff in h; destruct h as [h safe]. apply andb_true_iff in h; destruct h as [h slow].
  apply andb_true_iff in h; destruct h as [hs ht]. apply qlt_R in hs. apply qle_R in ht. rewrite Q2R_0 in hs.
  set (t := Q2R tau) in *. set (st := Q2R step) in *. assert (pt : 0 < t) by lra.
  assert (hk : 0 <= 1 - st / t <= 1).
  { assert (0 <= st / t <= 1); [|lra]. split; [apply Rmult_le_pos; [lra|left; now apply Rinv_0_lt_compat]|].
    apply Rmult_le_reg_r with t; [exact pt|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  rewrite forallb_forall in slow. split; [unfold st, t in *; lra|]. split.
  - intros d hd. specialize (slow d hd). apply andb_true_iff in slow. destruct slow as [c v]. apply at_most_length_ok in c, v.
    rewrite Q2R_mul in *. rewrite real_sub in c. split; [exact c|]. intro n. rewrite !velocity_left. fold st t. fold st in c. fold t in v.
    set (k := 1 - st / t) in *. unfold no_longer, dot, sub, scale in *; simpl in *. set (vx := fst (real (chosen d))) in *. set (vy := snd (real (chosen d))) in *.
    assert (e : forall u, k * k ^ n * u - k ^ n * u = - (k ^ n * (st / t * u))) by (intro u; unfold k; ring).
    rewrite !e.
    assert (b : (st / t * vx) * (st / t * vx) + (st / t * vy) * (st / t * vy) <= (Q2R (its_most d) * st) * (Q2R (its_most d) * st)).
    { replace (Q2R (its_most d) * st * (Q2R (its_most d) * st)) with ((st / t) * (st / t) * (Q2R (its_most d) * t * (Q2R (its_most d) * t))) by (field; lra).
      replace (st / t * vx * (st / t * vx) + st / t * vy * (st / t * vy)) with ((st / t) * (st / t) * (vx * vx + vy * vy)) by ring.
      apply Rmult_le_compat_l; [nra|exact v]. }
    apply Rle_trans with (2 := shrinks k n _ _ _ hk b). right. unfold vx, vy; simpl. ring.
  - intros n s hs'. pose proof (behind_within (1 - st / t) n s hk hs') as hb.
    assert (k : keeps_apart os (map (fun c => {| from := fst c; to := fst c; size := snd c |}) poles) (map (way_of_braking tau) ds)).
    { apply step_sound; [exact safe|]. intros m hm. apply in_map_iff in hm. destruct hm as [d [e hd]]. subst m.
      unfold place. rewrite mix_0, way_starts. now apply start. }
    destruct (k _ hb) as [pairs alone]. split.
    + apply pairs_map in pairs. apply pairs_impl with (2 := pairs). intros x y p. fold st t.
      rewrite !(while_braking_ok st tau) by exact pt. exact p.
    + intros d hd. destruct (alone (way_of_braking tau d) (in_map _ _ _ hd)) as [r p]. fold st t.
      rewrite (while_braking_ok st tau) by exact pt. split; [exact r|]. intros c hc.
      specialize (p _ (in_map (fun c => {| from := fst c; to := fst c; size := snd c |}) _ _ hc)).
      assert (e : forall q, place {| from := fst c; to := fst c; size := snd c |} q = real (fst c)).
      { intro q. apply mix_same. }
      unfold parted in p. rewrite e in p. now apply apart_symmetric.
Qed.
