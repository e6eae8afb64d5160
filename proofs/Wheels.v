(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Two wheels that hold a twist: the point ahead of the axle goes along an arc, and strays from the chord of it by no more
   than the curvature makes of it, which the length of the chord bounds. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems Plane Parity Turn.
Open Scope R_scope.

(* radius >= reach of the body + ahead + way^2 / (4 (2 ahead - way)) *)
Definition wheels_fit (k : wheels) (radius : Q) : bool :=
  let way := qmul (most_speed k) (time_step k) in let room := qmul 4 (qsub (qmul 2 (ahead k)) way) in
  qle 0 (body_reach k) && qle 0 (ahead k) && qle 0 way && qlt 0 (time_step k) && qlt 0 room
  && qle (qadd (qmul room (qadd (body_reach k) (ahead k))) (qmul way way)) (qmul room radius).

(* --- Lengths --- *)
Lemma no_longer_add a b x y : 0 <= a -> 0 <= b -> no_longer a x -> no_longer b y -> no_longer (a + b) (add x y).
Proof.
  unfold no_longer. intros a0 b0 hx hy. pose proof (bounded_dot x y a b a0 b0 hx hy) as k.
  replace (dot (add x y) (add x y)) with (dot x x + 2 * dot x y + dot y y) by (unfold dot, add; simpl; ring). nra.
Qed.
Lemma no_longer_more a b x : 0 <= a <= b -> no_longer a x -> no_longer b x.
Proof. unfold no_longer. intros h k. apply Rle_trans with (1 := k). apply Rmult_le_compat; lra. Qed.
Lemma no_longer_root l x : 0 <= l -> (forall n, - (sqrt (dot n n) * l) <= dot n x) -> no_longer l x.
Proof.
  intros l0 h. unfold no_longer. specialize (h (scale (-1) x)). set (k := sqrt _) in h.
  assert (kk : k * k = dot x x).
  { unfold k. rewrite sqrt_sqrt by apply dot_self. unfold dot, scale; simpl. ring. }
  assert (k0 : 0 <= k) by apply sqrt_pos. replace (dot (scale (-1) x) x) with (- dot x x) in h by (unfold dot, scale; simpl; ring).
  rewrite <- kk in *. assert (k <= l) by (destruct (Req_dec k 0); [lra|]; apply Rmult_le_reg_l with k; lra). apply Rmult_le_compat; assumption.
Qed.

(* --- phi^2 cos phi <= sin^2 phi --- *)
Lemma sine_beside_angle x : 0 <= x <= PI / 2 -> x * x * cos x <= sin x * sin x.
Proof.
  intro h. pose proof PI_4. destruct (sin_bound x 0) as [s _]; [lra|lra|]. destruct (cos_bound x 0) as [_ c]; [lra|lra|].
  unfold sin_approx, cos_approx, sin_term, cos_term in s, c. simpl in s, c.
  assert (s' : x * (1 - x * x / 6) <= sin x) by lra. assert (c' : cos x <= 1 - x * x / 2 + (x * x) * (x * x) / 24) by lra. clear s c.
  set (z := x * x) in *. assert (z0 : 0 <= z <= 4) by (unfold z; nra).
  assert (low : 0 <= x * (1 - z / 6)) by (apply Rmult_le_pos; lra).
  apply Rle_trans with ((x * (1 - z / 6)) * (x * (1 - z / 6))); [|apply Rmult_le_compat; assumption].
  apply Rle_trans with (z * (1 - z / 2 + z * z / 24)); [apply Rmult_le_compat_l; lra|].
  replace (x * (1 - z / 6) * (x * (1 - z / 6))) with (z * ((1 - z / 6) * (1 - z / 6))) by (unfold z; ring).
  apply Rmult_le_compat_l; [lra|]. nra.
Qed.

(* --- The arc of a point y: how far it strays from the chord, and the chord --- *)
Lemma strays o v w y T t : 0 < T -> 0 <= t <= T ->
  no_longer (Rabs w * sqrt (dot (moved v w y) (moved v w y)) * (T * T) / 8) (sub (carried o v w t y) (mix (t / T) (carried o v w 0 y) (carried o v w T y))).
Proof.
  intros T0 ht. set (u := moved v w y). set (V := sqrt (dot u u)). assert (V0 : 0 <= V) by apply sqrt_pos. assert (VV : V * V = dot u u) by (apply sqrt_sqrt, dot_self).
  assert (w0 := Rabs_pos w). assert (ww : Rabs w * Rabs w = w * w) by (rewrite <- Rabs_mult; apply Rabs_right; nra).
  apply no_longer_root; [apply Rmult_le_pos; [|lra]; apply Rmult_le_pos; [now apply Rmult_le_pos|nra]|]. intro n. set (N := sqrt (dot n n)). assert (N0 : 0 <= N) by apply sqrt_pos.
  assert (NN : N * N = dot n n) by (apply sqrt_sqrt, dot_self).
  destruct (carried_bends o v w n y (N * (Rabs w * V))) as [f [f1 [f2 [h [h1 [h2 h3]]]]]].
  - apply Rmult_le_pos; [assumption|now apply Rmult_le_pos].
  - fold u. rewrite <- VV, <- NN, <- ww. right. ring.
  - pose proof (dips_below_chord f f1 f2 (N * (Rabs w * V)) 0 T t h1 h2 h3 ltac:(apply Rmult_le_pos; [assumption|now apply Rmult_le_pos]) ht) as k.
    rewrite dot_sub, dot_mix, !h. apply Rmult_le_reg_r with T; [assumption|].
    replace ((f t - ((1 - t / T) * f 0 + t / T * f T)) * T) with (f t * T - (f 0 * (T - t) + f T * t)) by (field; lra). rewrite !Rminus_0_r in k. lra.
Qed.

(* The axle looks along h. *)
Lemma chord_ahead o h speed w d T : dot h h = 1 -> w <> 0 -> let s := sin (w * T / 2) in let c := cos (w * T / 2) in
  let way := sub (carried o (scale speed h) w T (scale d h)) (carried o (scale speed h) w 0 (scale d h)) in
  w * w * dot way way = 4 * (s * s) * (speed * speed + w * w * (d * d)) /\ dot (left_of h) way * c = s * (dot h way + 2 * d) /\
  dot way way = dot h way * dot h way + dot (left_of h) way * dot (left_of h) way.
Proof.
  intros hh z s c way. assert (one : s * s + c * c = 1) by (pose proof (sin2_cos2 (w * T / 2)) as k; unfold Rsqr in k; exact k).
  assert (es : sin (w * T) = 2 * s * c) by (replace (w * T) with (2 * (w * T / 2)) by field; apply sin_2a).
  assert (ec : 1 - cos (w * T) = 2 * (s * s)) by (replace (w * T) with (2 * (w * T / 2)) by field; rewrite cos_2a_sin; unfold s; ring).
  assert (ex : dot h way = 2 * s * c / w * speed - 2 * (s * s) * d).
  { unfold way, carried. destruct (Req_EM_T w 0); [contradiction|]. rewrite !Rmult_0_r, sin_0, cos_0, es, ec. replace (cos (w * T)) with (1 - 2 * (s * s)) by lra.
    replace (2 * s * c / w * speed - 2 * (s * s) * d) with ((2 * s * c / w * speed - 2 * (s * s) * d) * dot h h) by (rewrite hh; ring).
    unfold dot, sub, add, scale, left_of; simpl. field. assumption. }
  assert (ey : dot (left_of h) way = 2 * s * c * d + 2 * (s * s) / w * speed).
  { unfold way, carried. destruct (Req_EM_T w 0); [contradiction|]. rewrite !Rmult_0_r, sin_0, cos_0, es, ec. replace (cos (w * T)) with (1 - 2 * (s * s)) by lra.
    replace (2 * s * c * d + 2 * (s * s) / w * speed) with ((2 * s * c * d + 2 * (s * s) / w * speed) * dot h h) by (rewrite hh; ring).
    unfold dot, sub, add, scale, left_of; simpl. field. assumption. }
  assert (sum : dot way way = dot h way * dot h way + dot (left_of h) way * dot (left_of h) way).
  { replace (dot way way) with (dot h h * dot way way) by (rewrite hh; ring). unfold dot, left_of; simpl. ring. }
  split; [|split; [|assumption]].
  - rewrite sum, ex, ey. clear sum ex ey es ec. set (X := speed) in *.
    replace (4 * (s * s) * (X * X + w * w * (d * d))) with (4 * (s * s) * (X * X + w * w * (d * d)) * (s * s + c * c)) by (rewrite one; ring).
    field. assumption.
  - rewrite ex, ey. replace (s * (2 * s * c / w * speed - 2 * (s * s) * d + 2 * d)) with (2 * (s * s) * c / w * speed + 2 * s * d * (1 - s * s)) by (field; assumption).
    replace (1 - s * s) with (c * c) by lra. field. assumption.
Qed.

(* With half the angle, phi: the bound on straying, from what bounds the chord. *)
Lemma stray_small w V T L d : 0 < T -> 0 <= V -> 0 <= L < 2 * d -> Rabs (w * T) < PI -> w <> 0 ->
  2 * V * Rabs (sin (w * T / 2)) <= L * Rabs w -> Rabs (sin (w * T / 2)) * (2 * d - L) <= L * cos (w * T / 2) ->
  Rabs w * V * (T * T) / 8 * (4 * (2 * d - L)) <= L * L.
Proof.
  intros T0 V0 hL hw z h1 h2. set (phi := w * T / 2) in *. assert (p : Rabs phi < PI / 2).
  { unfold phi, Rdiv. rewrite Rabs_mult, (Rabs_right (/ 2)) by lra. lra. }
  assert (sq : Rabs phi * Rabs phi * cos phi <= Rabs (sin phi) * Rabs (sin phi) /\ 0 < Rabs (sin phi)).
  { assert (n : phi <> 0) by (unfold phi; intro e; apply z; assert (e' : w * T = 0) by lra; apply Rmult_integral in e'; destruct e'; [assumption|lra]).
    unfold Rabs in p |- *. destruct (Rcase_abs phi) as [neg|pos].
    - assert (s0 : sin phi < 0) by (rewrite <- (Ropp_involutive phi), sin_neg; assert (0 < sin (- phi)) by (apply sin_gt_0; lra); lra).
      destruct (Rcase_abs (sin phi)); [|lra]. pose proof (sine_beside_angle (- phi) ltac:(lra)) as k. rewrite cos_neg, sin_neg in k. split; [assumption|lra].
    - assert (s0 : 0 < sin phi) by (apply sin_gt_0; lra). destruct (Rcase_abs (sin phi)); [lra|]. split; [apply sine_beside_angle; lra|assumption]. }
  destruct sq as [sq s0]. set (s := Rabs (sin phi)) in *. set (c := cos phi) in *.
  assert (pp : Rabs phi * Rabs phi * 4 = Rabs w * Rabs w * (T * T)).
  { rewrite <- Rabs_mult, <- Rabs_mult. rewrite !Rabs_right by nra. unfold phi. field. }
  assert (w0 : 0 < Rabs w) by now apply Rabs_pos_lt. set (W := Rabs w) in *. set (P := Rabs phi) in *. clearbody s c W P.
  apply Rmult_le_reg_r with (s * s); [now apply Rmult_lt_0_compat|].
  replace (W * V * (T * T) / 8 * (4 * (2 * d - L)) * (s * s)) with (W * (T * T) / 4 * ((2 * V * s) * (s * (2 * d - L)))) by field.
  apply Rle_trans with (W * (T * T) / 4 * ((L * W) * (L * c))).
  - apply Rmult_le_compat_l; [apply Rmult_le_pos; [|lra]; apply Rmult_le_pos; nra|]. apply Rmult_le_compat; try assumption; apply Rmult_le_pos; lra.
  - replace (W * (T * T) / 4 * (L * W * (L * c))) with (L * L * ((W * W * (T * T)) / 4 * c)) by field. rewrite <- pp.
    replace (P * P * 4 / 4 * c) with (P * P * c) by field. apply Rmult_le_compat_l; [nra|assumption].
Qed.

Theorem wheels_sound k r : wheels_fit k r = true -> stays_within k (Q2R r).
Proof.
  unfold wheels_fit. set (way := qmul (most_speed k) (time_step k)). set (room := qmul 4 _). intro h.
  apply andb_true_iff in h; destruct h as [h fit]. apply andb_true_iff in h; destruct h as [h room0]. apply andb_true_iff in h; destruct h as [h T0].
  apply andb_true_iff in h; destruct h as [h way0]. apply andb_true_iff in h; destruct h as [b0 d0]. apply qle_R in b0, d0, way0, fit. apply qlt_R in room0, T0.
  unfold room in fit, room0. rewrite !Q2R_add, !Q2R_mul, Q2R_add, Q2R_sub, Q2R_mul, Q2R_2, Q2R_4 in fit. rewrite Q2R_mul, Q2R_sub, Q2R_mul, Q2R_2, Q2R_4, Q2R_0 in room0.
  rewrite Q2R_0 in b0, d0, T0, way0. unfold way in *. rewrite Q2R_mul in *. clear way room.
  intros o h speed w hh T after point chord half t y ht hy. cbv zeta in *. fold T in fit, room0, T0, way0. set (b := Q2R (body_reach k)) in *. set (d := Q2R (ahead k)) in *.
  set (L := Q2R (most_speed k) * T) in *. set (v := scale speed h) in *. set (q := scale d h) in *.
  set (S := Rabs w * sqrt (dot (moved v w q) (moved v w q)) * (T * T) / 8).
  assert (S0 : 0 <= S) by (unfold S; apply Rmult_le_pos; [|lra]; apply Rmult_le_pos; [apply Rmult_le_pos; [apply Rabs_pos|apply sqrt_pos]|nra]).
  assert (small : S * (4 * (2 * d - L)) <= L * L).
  { destruct (Req_dec w 0) as [z|z].
    - unfold S. rewrite z, Rabs_R0. nra.
    - assert (VV : dot (moved v w q) (moved v w q) = speed * speed + w * w * (d * d)).
      { replace (speed * speed + w * w * (d * d)) with ((speed * speed + w * w * (d * d)) * dot h h) by (rewrite hh; ring).
        unfold moved, v, q, dot, add, scale, left_of; simpl. ring. }
      destruct (chord_ahead o h speed w d T hh z) as [c1 [c2 c3]]. fold v q in c1, c2, c3. unfold point, after in chord. unfold no_longer in chord.
      set (u := sub _ _) in c1, c2, c3, chord. set (sn := sin (w * T / 2)) in *. set (cs := cos (w * T / 2)) in *. rewrite <- VV in c1.
      set (V := sqrt (dot (moved v w q) (moved v w q))) in *. assert (V0 : 0 <= V) by apply sqrt_pos.
      assert (V2 : V * V = dot (moved v w q) (moved v w q)) by (apply sqrt_sqrt, dot_self). rewrite <- V2 in c1.
      assert (w0 := Rabs_pos w). assert (ww : Rabs w * Rabs w = w * w) by (rewrite <- Rabs_mult; apply Rabs_right; nra).
      assert (s0 := Rabs_pos sn). assert (ss : Rabs sn * Rabs sn = sn * sn) by (rewrite <- Rabs_mult; apply Rabs_right; nra).
      assert (cpos : 0 <= cs).
      { unfold cs. apply cos_ge_0; unfold Rabs in half; destruct (Rcase_abs (w * T)); lra. }
      unfold S. apply stray_small; try assumption; try lra.
      + fold sn. apply square_le; [apply Rmult_le_pos; lra|]. replace (2 * V * Rabs sn * (2 * V * Rabs sn)) with (4 * (Rabs sn * Rabs sn) * (V * V)) by ring.
        rewrite ss, <- c1. replace (L * Rabs w * (L * Rabs w)) with (Rabs w * Rabs w * (L * L)) by ring. rewrite ww. apply Rmult_le_compat_l; [nra|assumption].
      + fold sn cs. set (X := dot h u) in *. set (Y := dot (left_of h) u) in *. assert (hX : - L <= X <= L) by (split; [apply Ropp_le_cancel|]; apply square_le; nra).
        assert (hY : Rabs Y <= L) by (apply square_le; [lra|]; rewrite <- Rabs_mult, Rabs_right; nra).
        assert (e : Rabs Y * cs = Rabs sn * (X + 2 * d)).
        { rewrite <- (Rabs_right cs) by lra. rewrite <- (Rabs_right (X + 2 * d)) by lra. rewrite <- !Rabs_mult. now rewrite c2. }
        apply Rle_trans with (Rabs sn * (X + 2 * d)); [apply Rmult_le_compat_l; lra|]. rewrite <- e. now apply Rmult_le_compat_r. }
  apply (no_longer_more ((b + d) + S)); [split; [lra|]|].
  { apply Rmult_le_reg_l with (4 * (2 * d - L)); [lra|]. lra. }
  replace (sub (after t y) (mix (t / T) (point 0) (point T))) with (add (sub (after t y) (point t)) (sub (point t) (mix (t / T) (point 0) (point T))))
    by (unfold add, sub; simpl; f_equal; ring).
  apply no_longer_add; [lra|assumption| |now apply strays].
  assert (turned : dot (sub (after t y) (point t)) (sub (after t y) (point t)) = dot (add y (scale (-1) q)) (add y (scale (-1) q))).
  { unfold after, point, after, carried. pose proof (sin2_cos2 (w * t)) as one. unfold Rsqr in one.
    replace (dot (add y (scale (-1) q)) (add y (scale (-1) q))) with ((sin (w * t) * sin (w * t) + cos (w * t) * cos (w * t)) * dot (add y (scale (-1) q)) (add y (scale (-1) q)))
      by (rewrite one; ring).
    unfold dot, sub, add, scale, left_of; simpl. ring. }
  unfold no_longer at 1. rewrite turned. apply no_longer_add; try lra; [assumption|]. unfold no_longer, q.
  replace (dot (scale (-1) (scale d h)) (scale (-1) (scale d h))) with (d * d * dot h h) by (unfold dot, scale; simpl; ring). rewrite hh. lra.
Qed.
