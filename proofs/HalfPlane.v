(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Half-planes against velocity obstacles, and points in ellipses. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems Plane.
Import ListNotations.
Open Scope R_scope.

(* k + sqrt b + sqrt d <= 0, by squaring twice. *)
Definition roots_below (k b d : Q) : bool :=
  let rest := qsub (qsub (qmul k k) b) d in
  qle k 0 && qle 0 b && qle 0 d && qle 0 rest && qle (qmul 4 (qmul b d)) (qmul rest rest).

Lemma roots_below_ok k b d : roots_below k b d = true ->
  0 <= Q2R b /\ 0 <= Q2R d /\ Q2R k + sqrt (Q2R b) + sqrt (Q2R d) <= 0.
Proof.
  unfold roots_below. intro h. reals. revert H3 H2 H1 H0 H. generalize (Q2R k) (Q2R b) (Q2R d). clear. intros k b d b0 d0 k0 rest h.
  repeat split; try lra. assert (sqrt b + sqrt d <= - k); [|lra]. apply square_le; [lra|].
  pose proof (sqrt_pos b). pose proof (sqrt_pos d). pose proof (sqrt_sqrt b). pose proof (sqrt_sqrt d).
  assert (2 * (sqrt b * sqrt d) <= k * k - b - d); [|nra]. apply square_le; [lra|].
  replace (2 * (sqrt b * sqrt d) * (2 * (sqrt b * sqrt d))) with (4 * ((sqrt b * sqrt b) * (sqrt d * sqrt d))) by ring.
  rewrite !sqrt_sqrt by lra. lra.
Qed.

(* The support function of a body as seen from a point: m + sqrt e. *)
Definition support (n from : point) (s : shape) : option (Q * Q) :=
  match s with
  | Polygon [] => None
  | Polygon (v :: vs) => Some (qsub (highest n v vs) (pdot n from), 0%Q)
  | Disc c r => if qle 0 r then Some (pdot n (psub c from), qmul (qmul r r) (pdot n n)) else None
  | Ellipse c l11 l21 l22 =>
      let x := qadd (qmul l11 (fst n)) (qmul l21 (snd n)) in let y := qmul l22 (snd n) in
      Some (pdot n (psub c from), qadd (qmul x x) (qmul y y))
  end.

Lemma dot_root x y b : dot x x <= b -> dot x y <= sqrt b * sqrt (dot y y).
Proof.
  intro h. pose proof (dot_self x). pose proof (dot_self y).
  apply bounded_dot; try apply sqrt_pos; rewrite sqrt_sqrt; lra.
Qed.

Lemma support_ok n f s m e : support n f s = Some (m, e) -> forall o, inside s o ->
  dot (real n) (sub o (real f)) <= Q2R m + sqrt (Q2R e).
Proof.
  intros h o ho. destruct s as [vs|c r|c l11 l21 l22]; simpl in h, ho.
  - destruct vs as [|v vs]; [discriminate|]. injection h as hm he. subst. reals. rewrite sqrt_0.
    assert (dot (real n) o <= Q2R (highest n v vs)) by (apply hull_below with (2 := ho); apply highest_ok).
    rewrite dot_sub. lra.
  - destruct (qle 0 r) eqn:hr; [|discriminate]. injection h as hm he. subst. reals.
    destruct ho as [_ ho]. pose proof (dot_root _ (real n) _ ho) as k.
    rewrite <- sqrt_mult in k; [|nra|apply dot_self]. unfold dot, sub in *; simpl in *; lra.
  - injection h as hm he. subst. reals. destruct ho as [a [b [ab e]]]. subst o.
    set (x := Q2R l11 * Q2R (fst n) + Q2R l21 * Q2R (snd n)). set (y := Q2R l22 * Q2R (snd n)).
    pose proof (dot_root (a, b) (x, y) 1) as k. unfold dot in k; simpl in k. rewrite sqrt_1, Rmult_1_l in k. specialize (k ab).
    unfold dot, sub, add, real; simpl. unfold x, y in *. lra.
Qed.

(* The whole horizon needs the least of 0 and horizon * beyond; where there is no horizon, beyond must not be negative. *)
Definition half_plane_holds (c : half_plane) : bool :=
  let n := normal c in let nn := pdot n n in let beyond := qsub (offset c) (pdot n (body_velocity c)) in
  let late := match horizon c with
    | Some h => if qlt 0 h then Some (qmin 0 (qmul h beyond)) else None
    | None => if qle 0 beyond then Some 0%Q else None
    end in
  match support n (position c) (body c), late with
  | Some (m, e), Some l => qlt 0 nn && qle 0 (radius c) && qle 0 (margin c)
      && roots_below (qadd (qsub m l) (margin c)) e (qmul (qmul (radius c) (radius c)) nn)
  | _, _ => false
  end.

Theorem half_plane_sound c : half_plane_holds c = true -> keeps_clear c.
Proof.
  unfold half_plane_holds. set (n := normal c). set (beyond := qsub (offset c) (pdot n (body_velocity c))).
  destruct (support n (position c) (body c)) as [[m e]|] eqn:hs; [|discriminate].
  destruct (match horizon c with Some _ => _ | None => _ end) as [l|] eqn:hl; [|discriminate].
  intros h v t o hv ht ho there here.
  pose proof (support_ok _ _ _ _ _ hs o ho) as sup.
  apply andb_true_iff in h; destruct h as [h roots]. apply roots_below_ok in roots. destruct roots as [e0 [d0 roots]]. reals.
  (* the strip: over time the offset gains at least l *)
  assert (gain : Q2R l <= t * (dot (real n) v - dot (real n) (real (body_velocity c)))).
  { assert (b : Q2R beyond <= dot (real n) v - dot (real n) (real (body_velocity c))) by (unfold beyond; reals; fold n in hv; lra).
    destruct ht as [t0 t1]. destruct (horizon c) as [h|].
    - destruct (qlt 0 h) eqn:h0; [|discriminate]. injection hl as hl. subst l. reals. rewrite Q2R_min, Q2R_0, Q2R_mul.
      destruct (Rle_or_lt 0 (Q2R beyond)); [rewrite Rmin_left; nra|rewrite Rmin_right; nra].
    - destruct (qle 0 beyond) eqn:h0; [|discriminate]. injection hl as hl. subst l. apply qle_R in h0. rewrite Q2R_0 in *. nra. }
  assert (root : sqrt (Q2R (radius c) * Q2R (radius c) * dot (real n) (real n)) = Q2R (radius c) * sqrt (dot (real n) (real n))).
  { rewrite sqrt_mult; [|nra|apply dot_self]. rewrite sqrt_square; lra. }
  rewrite root in roots.
  assert (k : Q2R (radius c) * sqrt (dot (real n) (real n)) + Q2R (margin c) <= dot (real n) (sub here there)).
  { unfold here, there. rewrite dot_sub, !dot_add, !dot_scale. rewrite dot_sub in sup. lra. }
  pose proof (sqrt_pos (dot (real n) (real n))) as p0. pose proof (sqrt_sqrt (dot (real n) (real n)) (dot_self _)) as p1.
  split.
  - apply far with (real n) (Q2R (radius c) * sqrt (dot (real n) (real n))); [assumption|nra| |lra].
    right. rewrite <- p1 at 1. ring.
  - intros y hy. fold n. pose proof (bounded_dot (sub here y) (real n) (Q2R (radius c)) (sqrt (dot (real n) (real n)))) as b.
    rewrite p1 in b. assert (dot (sub here y) (real n) <= Q2R (radius c) * sqrt (dot (real n) (real n))).
    { apply b; try lra. unfold dot, sub in *; simpl in *; lra. }
    rewrite dot_sub in k. unfold dot, sub in *; simpl in *; lra.
Qed.

(* --- Two robots whose half-planes are opposite: as one that sees the other from the relative velocity --- *)
Definition pair_holds (c : half_plane) (p : point) (r other : Q) : bool :=
  qle 0 r && qle 0 (radius c) && half_plane_holds {| body := Polygon [p]; body_velocity := (0, 0)%Q;
    position := position c; radius := qadd (radius c) r; horizon := horizon c; normal := normal c;
    offset := qadd (offset c) other; margin := 0%Q |}.

Theorem pair_sound c p r other : pair_holds c p r other = true -> keep_each_other_clear c p r other.
Proof.
  unfold pair_holds. intros h v w t hv hw ht. apply andb_true_iff in h; destruct h as [_ h].
  apply half_plane_sound in h. unfold keeps_clear in h; simpl in h.
  destruct (h (sub v w) t (real p)) as [k _]; [|exact ht|apply corner; now left|].
  - rewrite Q2R_add, dot_sub. replace (dot (scale (-1) (real (normal c))) w) with (- dot (real (normal c)) w) in hw by (unfold dot, scale; simpl; ring). lra.
  - rewrite Q2R_add in k. unfold apart, dot, sub, add, scale, real in *; simpl in *. rewrite Q2R_0 in k.
    apply Rle_trans with (1 := k). right. ring.
Qed.

(* --- Points in an ellipse: l11^2 l22^2 (1 - m - |L^-1 (x - c)|^2) >= 0, without a division --- *)
Definition contains (s : shape) (ps : list point) (m : Q) : bool :=
  match s with
  | Ellipse c l11 l21 l22 =>
      let d := qmul l11 l22 in let dd := qmul d d in let room := qmul (qsub 1 m) dd in
      qlt 0 dd && negb (match ps with [] => true | _ => false end) && qle 0 m &&
      forallb (fun x =>
        let dx := qsub (fst x) (fst c) in let dy := qsub (snd x) (snd c) in
        let a := qmul dx l22 in let b := qsub (qmul dy l11) (qmul l21 dx) in
        qle (qadd (qmul a a) (qmul b b)) room) ps
  | _ => false
  end.

Theorem contains_sound c l11 l21 l22 ps m : contains (Ellipse c l11 l21 l22) ps m = true ->
  forall x, hull ps x -> in_ellipse (1 - Q2R m) c l11 l21 l22 x.
Proof.
  unfold contains. intro h. apply andb_true_iff in h; destruct h as [h pts]. apply andb_true_iff in h; destruct h as [h m0].
  apply andb_true_iff in h; destruct h as [d0 _]. apply qlt_R in d0. rewrite Q2R_0, !Q2R_mul in d0. rewrite forallb_forall in pts.
  assert (n1 : Q2R l11 <> 0) by (intro z; rewrite z in d0; lra). assert (n2 : Q2R l22 <> 0) by (intro z; rewrite z in d0; lra).
  intros x hx. induction hx as [p hp|x y s _ ix _ iy hs].
  - specialize (pts p hp). reals. set (dx := Q2R (fst p) - Q2R (fst c)) in *. set (dy := Q2R (snd p) - Q2R (snd c)) in *.
    exists (dx / Q2R l11), ((dy - Q2R l21 * (dx / Q2R l11)) / Q2R l22). split.
    + apply Rmult_le_reg_r with (Q2R l11 * Q2R l22 * (Q2R l11 * Q2R l22)); [assumption|].
      apply Rle_trans with (2 := pts). right. field. now split.
    + unfold add, real; simpl. f_equal; unfold dx, dy; field; auto.
  - destruct ix as [a [b [hab ex]]], iy as [a' [b' [hab' ey]]]. exists ((1 - s) * a + s * a'), ((1 - s) * b + s * b'). split.
    + pose proof (Rle_0_sqr (a - a')) as qa. pose proof (Rle_0_sqr (b - b')) as qb. unfold Rsqr in qa, qb.
      assert (0 <= s * (1 - s)) by (apply Rmult_le_pos; lra).
      assert (0 <= s * (1 - s) * ((a - a') * (a - a') + (b - b') * (b - b'))) by (apply Rmult_le_pos; lra).
      replace (((1 - s) * a + s * a') * ((1 - s) * a + s * a') + ((1 - s) * b + s * b') * ((1 - s) * b + s * b'))
        with ((1 - s) * (a * a + b * b) + s * (a' * a' + b' * b') - s * (1 - s) * ((a - a') * (a - a') + (b - b') * (b - b'))) by ring.
      nra.
    + subst. unfold mix, add, scale; simpl. f_equal; ring.
Qed.
