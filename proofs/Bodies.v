(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Bodies that stand for an obstacle: both ends of each edge lie in one of them, and with them the edge. *)
Require Import Reals QArith Qreals List Bool Lra.
From ExactVO Require Import Theorems Plane Parity Route HalfPlane.
Import ListNotations.
Open Scope R_scope.

(* --- Points in a convex polygon: in one of the triangles from its first corner, or on a side of such a triangle --- *)
Definition in_triangle (v a b p : point) : bool :=
  let d := psub a v in let e := psub b v in let w := psub p v in
  let whole := pcross d e in let of_a := pcross w e in let of_b := pcross d w in
  qlt 0 whole && qle 0 of_a && qle 0 of_b && qle (qadd of_a of_b) whole.
Fixpoint in_fan (v : point) (ps : list point) (p : point) : bool :=
  match ps with
  | [] => peq p v
  | a :: r => on_edge (v, a) p || match r with b :: _ => on_edge (a, b) p || in_triangle v a b p || in_triangle v b a p | [] => false end || in_fan v r p
  end.
Definition has (b : shape) (p : point) : bool :=
  match b with
  | Polygon (v :: ps) => in_fan v ps p
  | Polygon [] => false
  | Disc c r => let d := psub p c in qle 0 r && qle (pdot d d) (qmul r r)
  | Ellipse _ _ _ _ => contains b [p] 0
  end.
Definition hold (bs : list shape) (o : obstacle) : bool :=
  forallb (fun e => existsb (fun b => has b (fst e) && has b (snd e)) bs) (edges_of o).

Lemma on_of a b ps x : In a ps -> In b ps -> on (a, b) x -> hull ps x.
Proof. intros ha hb h. apply hull_convex with (2 := h). intros q [e|[e|[]]]; subst; now apply corner. Qed.
Lemma in_triangle_ok v a b p ps : In v ps -> In a ps -> In b ps -> in_triangle v a b p = true -> hull ps (real p).
Proof.
  unfold in_triangle. intros hv ha hb h. cbv zeta in h. reals.
  set (d := sub (real a) (real v)) in *. set (e := sub (real b) (real v)) in *. set (w := sub (real p) (real v)) in *.
  assert (wx : cross d e * fst w = cross w e * fst d + cross d w * fst e) by (unfold cross; ring).
  assert (wy : cross d e * snd w = cross w e * snd d + cross d w * snd e) by (unfold cross; ring).
  set (D := cross d e) in *. set (A := cross w e) in *. set (B := cross d w) in *. clearbody D A B.
  assert (ps_v : hull ps (real v)) by now apply corner.
  destruct (Req_dec (A + B) 0) as [z|n].
  - assert (A = 0) by lra. assert (B = 0) by lra. subst A B. assert (fst w = 0) by nra. assert (snd w = 0) by nra.
    replace (real p) with (real v); [assumption|]. rewrite (surjective_pairing (real p)), (surjective_pairing (real v)). unfold w, sub in *; simpl in *. f_equal; lra.
  - set (y := mix (B / (A + B)) (real a) (real b)).
    assert (hy : hull ps y) by (apply chord; [now apply corner|now apply corner|apply share_bounds; lra]).
    replace (real p) with (mix ((A + B) / D) (real v) y); [apply chord; [assumption|assumption|apply share_bounds; lra]|].
    assert (k1 : fst w = A / D * fst d + B / D * fst e) by (apply Rmult_eq_reg_l with D; [rewrite wx; field|]; lra).
    assert (k2 : snd w = A / D * snd d + B / D * snd e) by (apply Rmult_eq_reg_l with D; [rewrite wy; field|]; lra).
    rewrite (surjective_pairing (real p)). unfold y, w, d, e, mix, add, scale, sub in *; cbn [fst snd] in *.
    replace (fst (real p)) with (fst (real v) + (fst (real p) - fst (real v))) by ring. replace (snd (real p)) with (snd (real v) + (snd (real p) - snd (real v))) by ring.
    rewrite k1, k2. f_equal; field; lra.
Qed.
Lemma in_fan_ok v ps p : forall l, in_fan v l p = true -> incl (v :: l) ps -> hull ps (real p).
Proof.
  intro l. induction l as [|a r ih]; intros h i; cbn [in_fan] in h.
  - apply peq_real in h. rewrite h. apply corner, i. now left.
  - assert (hv : In v ps) by (apply i; now left). assert (ha : In a ps) by (apply i; right; now left).
    apply orb_true_iff in h. destruct h as [h|h]; [|apply ih; [assumption|intros q [e|hq]; [subst; assumption|apply i; right; now right]]].
    apply orb_true_iff in h. destruct h as [h|h]; [apply on_edge_sound in h; now apply (on_of v a)|]. destruct r as [|b r]; [discriminate|].
    assert (hb : In b ps) by (apply i; right; right; now left). rewrite !orb_true_iff in h. destruct h as [[h|h]|h].
    + apply on_edge_sound in h. now apply (on_of a b).
    + now apply (in_triangle_ok v a b).
    + now apply (in_triangle_ok v b a).
Qed.

Lemma has_edge b e x : has b (fst e) = true -> has b (snd e) = true -> on e x -> inside b x.
Proof.
  intros h k o. destruct e as [p q]. cbn [fst snd] in *. destruct b as [vs|c r|c l11 l21 l22]; cbn [has inside] in *.
  - destruct vs as [|v vs]; [discriminate|]. pose proof (in_fan_ok v (v :: vs) p vs h (incl_refl _)) as hp. pose proof (in_fan_ok v (v :: vs) q vs k (incl_refl _)) as hq.
    apply on_mix in o. destruct o as [s [hs e]]. subst. now apply chord.
  - reals. split; [assumption|]. apply on_mix in o. destruct o as [s [hs e]]. subst. set (R2 := Q2R r * Q2R r) in *.
    set (u := sub (real p) (real c)) in *. set (w := sub (real q) (real c)) in *.
    replace (sub (mix s (real p) (real q)) (real c)) with (mix s u w) by (unfold u, w, mix, sub, add, scale; simpl; f_equal; ring).
    replace (dot (mix s u w) (mix s u w)) with ((1 - s) * dot u u + s * dot w w - s * (1 - s) * dot (sub u w) (sub u w)) by (unfold dot, mix, sub, add, scale; simpl; ring).
    assert (0 <= s * (1 - s) * dot (sub u w) (sub u w)) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|apply dot_self]).
    assert ((1 - s) * dot u u <= (1 - s) * R2) by (apply Rmult_le_compat_l; lra). assert (s * dot w w <= s * R2) by (apply Rmult_le_compat_l; lra). lra.
  - assert (both : contains (Ellipse c l11 l21 l22) [p; q] 0 = true).
    { unfold contains in *. cbn [forallb negb] in *. rewrite !andb_true_iff in *. tauto. }
    apply contains_sound with (x := x) in both; [|assumption]. now rewrite Q2R_0, Rminus_0_r in both.
Qed.

Theorem hold_sound bs o : hold bs o = true -> held_by bs o.
Proof.
  unfold hold. intros h e x he hx. rewrite forallb_forall in h. specialize (h e he). apply existsb_exists in h. destruct h as [b [hb h]].
  apply andb_true_iff in h. destruct h as [h k]. exists b. split; [assumption|]. now apply (has_edge b e x).
Qed.
