(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Certificates that a body which drives and turns stays clear of an obstacle: along a direction a corner goes as a
   sinusoid does, which between two moments is nowhere lower than at these, but for its curvature. *)
Require Import Reals QArith Qreals List Bool Arith ZArith Lra Psatz.
From ExactVO Require Import Theorems Plane Parity Route Sine Sweep.
Import ListNotations.
Open Scope R_scope.

(* --- A function whose second derivative is at most m --- *)
Lemma dips_below_chord f f1 f2 m a b t : (forall c, derivable_pt_lim f c (f1 c)) -> (forall c, derivable_pt_lim f1 c (f2 c)) -> (forall c, f2 c <= m) -> 0 <= m ->
  a <= t <= b -> f a * (b - t) + f b * (t - a) - m * ((b - a) * (b - a)) / 8 * (b - a) <= f t * (b - a).
Proof.
  intros h1 h2 hm m0 ht. assert (0 <= m * ((b - a) * (b - a)) / 8 * (b - a)) by (apply Rmult_le_pos; [apply Rmult_le_pos; [apply Rmult_le_pos; nra|lra]|lra]).
  destruct (Req_dec a t) as [e|na]; [subst; lra|]. destruct (Req_dec b t) as [e|nb]; [subst; lra|].
  assert (hg : forall c, derivable_pt_lim (fun x => f x - m / 2 * (x * x)) c (f1 c - m * c)).
  { intro c. apply (derivable_pt_lim_minus f (fun x => m / 2 * (x * x))); [apply h1|].
    replace (m * c) with (m / 2 * (1 * c + c * 1)) by field.
    apply (derivable_pt_lim_scal (fun x => x * x)), (derivable_pt_lim_mult id id); apply derivable_pt_lim_id. }
  destruct (MVT_cor2 _ _ a t ltac:(lra) (fun c _ => hg c)) as [c [ec hc]]. destruct (MVT_cor2 _ _ t b ltac:(lra) (fun c _ => hg c)) as [d [ed hd]].
  destruct (MVT_cor2 f1 f2 c d ltac:(lra) (fun c _ => h2 c)) as [u [eu hu]]. specialize (hm u).
  assert (k : f1 d - m * d <= f1 c - m * c) by nra. clear h1 h2 hg eu.
  set (p := f1 d - m * d) in *. set (q := f1 c - m * c) in *. clearbody p q.
  assert (l : (f b - f t - m / 2 * (b * b - t * t)) * (t - a) <= (f t - f a - m / 2 * (t * t - a * a)) * (b - t)).
  { replace (f b - f t - m / 2 * (b * b - t * t)) with (p * (b - t)) by lra. replace (f t - f a - m / 2 * (t * t - a * a)) with (q * (t - a)) by lra.
    replace (p * (b - t) * (t - a)) with (p * ((b - t) * (t - a))) by ring. replace (q * (t - a) * (b - t)) with (q * ((b - t) * (t - a))) by ring.
    apply Rmult_le_compat_r; nra. }
  assert (between : (t - a) * (b - t) <= (b - a) * (b - a) / 4) by (pose proof (Rle_0_sqr (b - t - (t - a))) as sq; unfold Rsqr in sq; nra).
  assert (bent : m / 2 * ((b - a) * ((t - a) * (b - t))) <= m * ((b - a) * (b - a)) / 8 * (b - a)).
  { replace (m * ((b - a) * (b - a)) / 8 * (b - a)) with (m / 2 * ((b - a) * ((b - a) * (b - a) / 4))) by field.
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; lra. }
  assert (e : (f t - f a - m / 2 * (t * t - a * a)) * (b - t) - (f b - f t - m / 2 * (b * b - t * t)) * (t - a)
    = f t * (b - a) - (f a * (b - t) + f b * (t - a)) + m / 2 * ((b - a) * ((t - a) * (b - t)))) by field.
  lra.
Qed.
Lemma dips f f1 f2 m a b t : (forall c, derivable_pt_lim f c (f1 c)) -> (forall c, derivable_pt_lim f1 c (f2 c)) -> (forall c, f2 c <= m) -> 0 <= m ->
  a <= t <= b -> Rmin (f a) (f b) - m * ((b - a) * (b - a)) / 8 <= f t.
Proof.
  intros h1 h2 hm m0 ht. pose proof (Rmin_l (f a) (f b)). pose proof (Rmin_r (f a) (f b)). assert (0 <= m * ((b - a) * (b - a))) by (apply Rmult_le_pos; nra).
  destruct (Req_dec a b) as [e|n]; [assert (t = a) by lra; subst; lra|].
  pose proof (dips_below_chord f f1 f2 m a b t h1 h2 hm m0 ht) as k.
  assert (low : (Rmin (f a) (f b)) * (b - a) <= f a * (b - t) + f b * (t - a)) by nra.
  apply Rmult_le_reg_r with (b - a); lra.
Qed.

(* --- The place of a point of the body along a direction --- *)
Definition wave (a d b c w t : R) := a + d * t + b * sin (w * t) + c * cos (w * t).
Lemma wave_slope a d b c w t : derivable_pt_lim (wave a d b c w) t (d + w * (b * cos (w * t) - c * sin (w * t))).
Proof.
  unfold wave. assert (inner : derivable_pt_lim (fun t => w * t) t (w * 1)) by (apply (derivable_pt_lim_scal id), derivable_pt_lim_id).
  replace (d + w * (b * cos (w * t) - c * sin (w * t))) with (0 + d * 1 + b * (cos (w * t) * (w * 1)) + c * (- sin (w * t) * (w * 1))) by ring.
  apply (derivable_pt_lim_plus (fun t => a + d * t + b * sin (w * t))).
  - apply (derivable_pt_lim_plus (fun t => a + d * t)).
    + apply (derivable_pt_lim_plus (fun _ => a)); [apply derivable_pt_lim_const|apply (derivable_pt_lim_scal id), derivable_pt_lim_id].
    + apply (derivable_pt_lim_scal (fun t => sin (w * t))), (derivable_pt_lim_comp (fun t => w * t) sin); [assumption|apply derivable_pt_lim_sin].
  - apply (derivable_pt_lim_scal (fun t => cos (w * t))), (derivable_pt_lim_comp (fun t => w * t) cos); [assumption|apply derivable_pt_lim_cos].
Qed.
Lemma wave_bend b c w t m : 0 <= m -> (w * w * (b * b + c * c)) * (w * w) <= m * m ->
  0 + w * (- w * c * cos (w * t) - w * b * sin (w * t)) <= m.
Proof.
  intros m0 h. apply square_le; [assumption|]. apply Rle_trans with (2 := h).
  pose proof (sin2_cos2 (w * t)) as one. unfold Rsqr in one. set (s := sin (w * t)) in *. set (k := cos (w * t)) in *.
  replace ((0 + w * (- w * c * k - w * b * s)) * (0 + w * (- w * c * k - w * b * s))) with ((w * w) * (w * w) * ((c * k + b * s) * (c * k + b * s))) by ring.
  replace (w * w * (b * b + c * c) * (w * w)) with ((w * w) * (w * w) * (b * b + c * c)) by ring.
  apply Rmult_le_compat_l; [nra|]. pose proof (cauchy_schwarz (c, b) (k, s)) as cs. unfold dot in cs; simpl in cs. nra.
Qed.

Definition moved (v : vec) (w : R) (y : vec) : vec := add v (scale w (left_of y)).   (* its velocity at the start *)
Lemma carried_along o v w n y : exists a e b c : R, (forall t, dot n (carried o v w t y) = wave a e b c w t) /\
  w * w * (b * b + c * c) * (w * w) = w * w * (dot n n * dot (moved v w y) (moved v w y)).
Proof.
  destruct (Req_dec w 0) as [z|z].
  - exists (dot n o), (dot n v), (dot n (left_of y)), (dot n y). split; [|rewrite z; ring].
    intro t. unfold carried, wave. destruct (Req_EM_T w 0); [|contradiction]. unfold dot, add, scale; simpl. ring.
  - exists (dot n o + dot n (left_of v) / w), 0, (dot n v / w + dot n (left_of y)), (dot n y - dot n (left_of v) / w). split.
    + intro t. unfold carried, wave. destruct (Req_EM_T w 0); [contradiction|]. unfold dot, add, scale; simpl. field. assumption.
    + unfold moved, dot, add, scale, left_of; simpl. field. assumption.
Qed.
Lemma driven_along d n y : exists a e b c : R, (forall t, dot n (driven d t y) = wave a e b c (Q2R (turns d)) t).
Proof. destruct (carried_along (real (place_then d)) (real (heads d)) (Q2R (turns d)) n y) as [a [e [b [c [h _]]]]]. now exists a, e, b, c. Qed.

(* The bounds on curvature of `dips`, of a point of a body along n. *)
Lemma carried_bends o v w n y m : let u := moved v w y in 0 <= m -> w * w * (dot n n * dot u u) <= m * m -> exists f f1 f2 : R -> R,
  (forall t, dot n (carried o v w t y) = f t) /\ (forall c, derivable_pt_lim f c (f1 c)) /\ (forall c, derivable_pt_lim f1 c (f2 c)) /\ (forall c, f2 c <= m).
Proof.
  intros u m0 hm. destruct (carried_along o v w n y) as [k [e [p [q [h bend]]]]]. fold u in bend. rewrite <- bend in hm.
  exists (wave k e p q w), (wave e 0 (- w * q) (w * p) w), (fun t => 0 + w * (- w * q * cos (w * t) - w * p * sin (w * t))). split; [assumption|]. split; [|split].
  - intro c. pose proof (wave_slope k e p q w c) as s. replace (wave e 0 (- w * q) (w * p) w c) with (e + w * (p * cos (w * c) - q * sin (w * c))); [assumption|]. unfold wave. ring.
  - intro c. apply wave_slope.
  - intro c. now apply (wave_bend p q w c m).
Qed.
Lemma driven_dips d n y m a b t : let u := moved (real (heads d)) (Q2R (turns d)) y in 0 <= m ->
  Q2R (turns d) * Q2R (turns d) * (dot n n * dot u u) <= m * m -> a <= t <= b ->
  Rmin (dot n (driven d a y)) (dot n (driven d b y)) - m * ((b - a) * (b - a)) / 8 <= dot n (driven d t y).
Proof.
  intros u m0 hm ht. unfold driven. destruct (carried_bends (real (place_then d)) (real (heads d)) (Q2R (turns d)) n y m m0 hm) as [f [f1 [f2 [h [h1 [h2 h3]]]]]].
  rewrite !h. now apply (dips f f1 f2).
Qed.

Lemma derivable_near f f1 t e : derivable_pt_lim f t f1 -> 0 < e -> exists k, 0 < k /\ forall s, Rabs (s - t) < k -> Rabs (f s - f t) < e.
Proof.
  intros h e0. assert (c : continuity_pt f t) by (apply derivable_continuous_pt; now exists f1).
  destruct (c e e0) as [k [k0 hk]]. exists k. split; [assumption|]. intros s hs. destruct (Req_dec s t) as [q|n].
  - subst. now rewrite Rminus_diag_eq, Rabs_R0.
  - apply (hk s). split; [|assumption]. split; [exact I|]. now apply not_eq_sym.
Qed.
Lemma driven_continuous d y l : continuous (fun u => driven d (u * l) y).
Proof.
  intros t _ e e0.
  assert (along : forall n, exists k, 0 < k /\ forall s, Rabs (s - t) < k -> Rabs (dot n (driven d (s * l) y) - dot n (driven d (t * l) y)) < e).
  { intro n. destruct (driven_along d n y) as [a [b [p [q h]]]].
    destruct (derivable_near (wave a b p q (Q2R (turns d))) _ (t * l) e (wave_slope _ _ _ _ _ _) e0) as [k [k0 hk]].
    assert (l0 : 0 < Rabs l + 1) by (pose proof (Rabs_pos l); lra). exists (k / (Rabs l + 1)). split; [now apply Rdiv_lt_0_compat|].
    intros s hs. rewrite !h. apply hk. replace (s * l - t * l) with ((s - t) * l) by ring. rewrite Rabs_mult.
    apply Rle_lt_trans with (Rabs (s - t) * (Rabs l + 1)); [apply Rmult_le_compat_l; [apply Rabs_pos|lra]|].
    apply Rmult_lt_compat_r with (r := Rabs l + 1) in hs; [|assumption]. replace (k / (Rabs l + 1) * (Rabs l + 1)) with k in hs by (field; lra). assumption. }
  destruct (along (1, 0)) as [k [k0 hk]]. destruct (along (0, 1)) as [m [m0 hm]]. exists (Rmin k m). split; [now apply Rmin_glb_lt|].
  intros s _ hs. pose proof (Rmin_l k m). pose proof (Rmin_r k m). specialize (hk s ltac:(lra)). specialize (hm s ltac:(lra)).
  unfold dot in hk, hm; simpl in hk, hm. rewrite !Rmult_0_l, !Rmult_1_l in hk, hm. unfold near. split; [rewrite !Rplus_0_r in hk|rewrite !Rplus_0_l in hm]; assumption.
Qed.
Lemma driven_affine d t s x y : driven d t (mix s x y) = mix s (driven d t x) (driven d t y).
Proof. unfold driven, carried, mix, add, scale, left_of; simpl. f_equal; ring. Qed.
Lemma driven_at_start d y : driven d 0 y = add (real (place_then d)) y.
Proof.
  unfold driven, carried. rewrite !Rmult_0_r, sin_0, cos_0. destruct y, (Req_EM_T (Q2R (turns d)) 0); unfold add, scale, left_of; simpl; f_equal; field; assumption.
Qed.

(* --- Places in fractions, times the turn rate, which is no divisor then; a body that does not turn is at `times` = 1. What
   depends on the drive alone is computed once, before a corner or a moment is given --- *)
Definition qabs (a : Q) : Q := if qle 0 a then a else qopp a.
Definition unity (a : Q) : Q := Qmake (Zpos (Qden a)) (Qden a).   (* 1, over the denominator of a *)
Definition pscale (k : Q) (a : point) : point :=
  let x := qmul k (fst a) in (x, Qmake (Qnum k * Qnum (snd a)) (if Pos.eqb (Qden (fst a)) (Qden (snd a)) then Qden x else Qden k * Qden (snd a))).
Definition straight (d : drive) : bool := qeq (turns d) 0.
Definition times (d : drive) : Q := if straight d then unity (turns d) else qabs (turns d).
Definition aside (d : drive) : point := pscale (if qle 0 (turns d) then unity (turns d) else qopp (unity (turns d))) (pturn (heads d)).
Definition arm (d : drive) : point -> point :=
  let along := straight d in let k := times d in let a := aside d in fun q => let p := pscale k q in if along then p else psub p a.
Definition pose (g : positive) (d : drive) : Q -> option (point * near_circle) :=
  let along := straight d in let start := pscale (times d) (place_then d) in let hub := padd start (aside d) in fun passed =>
    if along then Some (padd start (pscale passed (heads d)), (0, Zpos g, 0)%Z)
    else match circle g (qmul (turns d) passed) with Some c => Some (hub, c) | None => None end.

Lemma Q2R_abs a : Q2R (qabs a) = Rabs (Q2R a).
Proof.
  unfold qabs. destruct (qle 0 a) eqn:h.
  - apply qle_R in h. rewrite Q2R_0 in h. rewrite Rabs_right; lra.
  - assert (l : qlt a 0 = true) by (unfold qlt; now rewrite h). apply qlt_R in l. rewrite Q2R_0 in l. rewrite Q2R_neg, Rabs_left; lra.
Qed.
Lemma Q2R_unity a : Q2R (unity a) = 1.
Proof. unfold unity, Q2R; simpl. field. apply IZR_neq. discriminate. Qed.
Lemma real_scale k a : real (pscale k a) = scale (Q2R k) (real a).
Proof.
  assert (e : pscale k a = (qmul k (fst a), qmul k (snd a))); [|rewrite e; unfold real, scale; cbn [fst snd]; now rewrite !Q2R_mul].
  unfold pscale, qmul; cbn [Qnum Qden]. destruct (Pos.eqb_spec (Qden (fst a)) (Qden (snd a))) as [e|_]; [rewrite e|]; reflexivity.
Qed.
Lemma real_add a b : real (padd a b) = add (real a) (real b).
Proof. unfold real, padd, add; simpl. now rewrite !Q2R_add. Qed.
Lemma real_turn a : real (pturn a) = left_of (real a).
Proof. unfold real, pturn, left_of; simpl. now rewrite Q2R_neg. Qed.
Lemma straight_ok d : straight d = true <-> Q2R (turns d) = 0.
Proof. unfold straight. rewrite qeq_iff, Q2R_0. tauto. Qed.
Lemma times_ok d : 0 < Q2R (times d) /\ (Q2R (turns d) <> 0 -> Q2R (times d) = Rabs (Q2R (turns d))).
Proof.
  unfold times. destruct (straight d) eqn:h.
  - apply straight_ok in h. rewrite Q2R_unity. split; [lra|intro n; contradiction].
  - rewrite Q2R_abs. assert (n : Q2R (turns d) <> 0) by (intro n; apply straight_ok in n; congruence). split; [now apply Rabs_pos_lt|reflexivity].
Qed.
Lemma aside_ok d : exists sign, sign * Q2R (turns d) = Rabs (Q2R (turns d)) /\ real (aside d) = scale sign (left_of (real (heads d))).
Proof.
  unfold aside. destruct (qle 0 (turns d)) eqn:h.
  - exists 1. apply qle_R in h. rewrite Q2R_0 in h. rewrite real_scale, real_turn, Q2R_unity, Rabs_right by lra. split; [ring|reflexivity].
  - assert (l : qlt (turns d) 0 = true) by (unfold qlt; now rewrite h). apply qlt_R in l. rewrite Q2R_0 in l.
    exists (-1). rewrite real_scale, real_turn, Q2R_neg, Q2R_unity, Rabs_left by lra. split; [ring|]. f_equal.
Qed.

Lemma pose_ok g d passed z c : apt g (terms g) -> pose g d passed = Some (z, c) -> exists si co, encloses g c si co /\ forall q,
  scale (Q2R (times d)) (driven d (Q2R passed) (real q)) = add (real z) (add (scale co (real (arm d q))) (scale si (left_of (real (arm d q))))).
Proof.
  intro ap. unfold pose, arm. cbv zeta. destruct (straight d) eqn:h; intro e.
  - injection e as e1 e2. subst. exists 0, 1. split.
    + unfold encloses. rewrite Rmult_0_l, Rmult_1_l, !Rminus_diag_eq by reflexivity. rewrite Rabs_R0. lra.
    + intro q. unfold times. rewrite h. apply straight_ok in h. rewrite !real_add, !real_scale, Q2R_unity. unfold driven, carried.
      destruct (Req_EM_T (Q2R (turns d)) 0); [|contradiction]. rewrite h, Rmult_0_l, sin_0, cos_0. unfold add, scale, left_of; simpl. f_equal; ring.
  - destruct (circle g (qmul (turns d) passed)) as [k|] eqn:f; [|discriminate]. injection e as e1 e2. subst. apply (circle_ok _ _ _ ap) in f. rewrite Q2R_mul in f.
    assert (n : Q2R (turns d) <> 0) by (intro n; apply straight_ok in n; congruence). destruct (times_ok d) as [_ t]. specialize (t n).
    exists (sin (Q2R (turns d) * Q2R passed)), (cos (Q2R (turns d) * Q2R passed)). split; [assumption|]. intro q.
    destruct (aside_ok d) as [sign [es ea]]. rewrite real_sub, !real_add, !real_scale, ea, t, <- es. unfold driven, carried.
    destruct (Req_EM_T (Q2R (turns d)) 0); [contradiction|]. unfold add, sub, scale, left_of; simpl. f_equal; field; assumption.
Qed.

(* --- How far, times g and `times`, a corner is at least beyond what lies up to `far` along n --- *)
Definition gap_of (g : positive) (n : point) (far : Q) (z : point) (c : near_circle) (p : point) : Q := let '(s, k, e) := c in
  let a := pdot n p in let b := pdot n (pturn p) in
  qsub (qadd (qmul (Qmake (Zpos g) 1) (qsub (pdot n z) far)) (qadd (qmul (Qmake k 1) a) (qmul (Qmake s 1) b))) (qmul (Qmake e 1) (qadd (qabs a) (qabs b))).
Lemma Q2R_whole a : Q2R (Qmake a 1) = IZR a.
Proof. unfold Q2R; simpl. lra. Qed.
Lemma near_times x y e a : Rabs (x - y) <= e -> y * a - e * Rabs a <= x * a.
Proof.
  intro h. assert (k : Rabs ((x - y) * a) <= e * Rabs a) by (rewrite Rabs_mult; apply Rmult_le_compat_r; [apply Rabs_pos|assumption]).
  pose proof (Rabs_pos ((x - y) * a)). unfold Rabs at 1 in k. destruct (Rcase_abs ((x - y) * a)); nra.
Qed.
Lemma gap_of_ok g n far z c p si co : encloses g c si co ->
  Q2R (gap_of g n far z c p) <= IZR (Zpos g) * (dot (real n) (add (real z) (add (scale co (real p)) (scale si (left_of (real p))))) - Q2R far).
Proof.
  destruct c as [[s k] e]. unfold encloses, gap_of. intros [hs hk].
  rewrite Q2R_sub, !Q2R_add, !Q2R_mul, Q2R_add, Q2R_sub, !Q2R_abs, !Q2R_whole, !Q2R_dot, real_turn, !dot_add, !dot_scale.
  set (a := dot (real n) (real p)). set (b := dot (real n) (left_of (real p))).
  pose proof (near_times _ _ _ a hk). pose proof (near_times _ _ _ b hs). lra.
Qed.

(* --- Its speed, from above, and how far it strays from a straight way --- *)
Definition fine : positive := Pos.pow 2 128.
Definition speed2 (d : drive) : point -> Q :=
  let v := pscale (unity (turns d)) (heads d) in fun q => let u := padd v (pscale (turns d) (pturn q)) in pdot u u.
Definition root_above (square : Q) : Q := Qmake (Z.sqrt (up (fine * fine) square) + 1) fine.
Definition is_above (root square : Q) : bool := qle 0 root && qle square (qmul root root).
Definition bend (d : drive) (speed : Q) : Q := qmul (qmul (qmul (times d) (qabs (turns d))) speed) (1 # 8).
(* No corner q is faster than v. *)
Definition no_faster (d : drive) (q : point) (v : Q) := 0 <= Q2R v /\
  let u := moved (real (heads d)) (Q2R (turns d)) (real q) in dot u u <= Q2R v * Q2R v.
Lemma speed_ok d q square v : is_above v square = true -> Q2R (speed2 d q) <= Q2R square -> no_faster d q v.
Proof.
  unfold is_above, no_faster. cbv zeta. unfold speed2. intros h l. apply andb_true_iff in h. destruct h as [h k]. apply qle_R in h, k. rewrite Q2R_0 in h. rewrite Q2R_mul in k.
  apply (Rle_trans _ _ _ l) in k. rewrite Q2R_dot, real_add, !real_scale, real_turn, Q2R_unity in k. split; [assumption|].
  replace (moved (real (heads d)) (Q2R (turns d)) (real q)) with (add (scale 1 (real (heads d))) (scale (Q2R (turns d)) (left_of (real q)))); [assumption|].
  unfold moved, add, scale; simpl. f_equal; ring.
Qed.

Lemma bend_positive d v : 0 <= Q2R v -> 0 <= Q2R (bend d v).
Proof.
  intro v0. unfold bend. rewrite !Q2R_mul, Q2R_abs. destruct (times_ok d) as [t0 _]. pose proof (Rabs_pos (Q2R (turns d))).
  apply Rmult_le_pos; [apply Rmult_le_pos; [apply Rmult_le_pos|]; lra|]. unfold Q2R; simpl. lra.
Qed.

(* --- Between two moments: what is enough at both, for a corner and an edge that reaches no farther than `far` --- *)
Lemma enough d q v n a b t far reach : no_faster d q v -> a <= t <= b ->
  (forall c, c = a \/ c = b -> (Q2R (times d) * reach + Q2R (bend d v) * ((b - a) * (b - a))) * sqrt (dot n n) < Q2R (times d) * dot n (driven d c (real q)) - far) ->
  forall x, Q2R (times d) * dot n x <= far -> reach * sqrt (dot n n) < dot n (driven d t (real q)) - dot n x.
Proof.
  intros known ht h x edge_low. destruct (times_ok d) as [t0 _]. destruct known as [v0 hv]. cbv zeta in hv.
  assert (fa := h a (or_introl eq_refl)). assert (fb := h b (or_intror eq_refl)). clear h.
  assert (eb : Q2R (bend d v) = Q2R (times d) * Rabs (Q2R (turns d)) * Q2R v / 8).
  { unfold bend. rewrite !Q2R_mul, Q2R_abs. unfold Q2R at 4; simpl. field. }
  set (N := sqrt (dot n n)) in *. assert (N0 : 0 <= N) by apply sqrt_pos. assert (NN : N * N = dot n n) by (apply sqrt_sqrt, dot_self).
  pose proof (driven_dips d n (real q) (N * (Rabs (Q2R (turns d)) * Q2R v)) a b t) as dip. cbv zeta in dip.
  assert (dip' : Rmin (dot n (driven d a (real q))) (dot n (driven d b (real q))) - N * (Rabs (Q2R (turns d)) * Q2R v) * ((b - a) * (b - a)) / 8
    <= dot n (driven d t (real q))).
  { apply dip; [| |assumption].
    - apply Rmult_le_pos; [assumption|]. apply Rmult_le_pos; [apply Rabs_pos|assumption].
    - set (W := Q2R (turns d)) in *. set (V := Q2R v) in *. assert (WW : Rabs W * Rabs W = W * W) by (rewrite <- Rabs_mult; apply Rabs_right; nra).
      replace (N * (Rabs W * V) * (N * (Rabs W * V))) with ((Rabs W * Rabs W) * ((N * N) * (V * V))) by ring. rewrite WW, NN.
      apply Rmult_le_compat_l; [nra|]. apply Rmult_le_compat_l; [apply dot_self|assumption]. }
  clear dip. set (T := Q2R (times d)) in *. set (L := Q2R (bend d v)) in *. set (S := b - a) in *.
  set (F := dot n (driven d t (real q))) in *. set (fA := dot n (driven d a (real q))) in *. set (fB := dot n (driven d b (real q))) in *.
  assert (both : (T * reach + L * (S * S)) * N < T * Rmin fA fB - far) by (unfold Rmin; destruct (Rle_dec fA fB); assumption).
  assert (curved : T * (N * (Rabs (Q2R (turns d)) * Q2R v) * (S * S) / 8) = L * (S * S) * N) by (rewrite eb; field).
  apply Rmult_lt_reg_l with T; [assumption|]. apply Rmult_le_compat_l with (r := T) in dip'; [|lra].
  rewrite Rmult_minus_distr_l in dip'. rewrite curved in dip'. lra.
Qed.
Lemma edge_far d n e x : on e x -> Q2R (times d) * dot (real n) x <= Q2R (qmax (pdot n (pscale (times d) (fst e))) (pdot n (pscale (times d) (snd e)))).
Proof.
  intro hx. destruct (times_ok d) as [t0 _]. rewrite Q2R_max, !Q2R_dot, !real_scale, !dot_scale. set (T := Q2R (times d)) in *.
  assert (hb : dot (real n) x <= Rmax (dot (real n) (real (fst e))) (dot (real n) (real (snd e)))).
  { apply hull_below with (2 := hx). intros y [ey|[ey|[]]]; subst; [apply Rmax_l|apply Rmax_r]. }
  rewrite (RmaxRmult _ _ T (Rlt_le _ _ t0)). apply Rmult_le_compat_l; lra.
Qed.
Definition clear_between (d : drive) (p : part) (e : edge) (s : separation) := exists n,
  forall t, Q2R (since s) - Q2R (sets_out d) <= t <= Q2R (until s) - Q2R (sets_out d) -> forall q x, In q (corners p) -> on e x ->
  Q2R (reach p) * sqrt (dot n n) < dot n (driven d t (real q)) - dot n x.

(* --- One separation, as exactly as sines go --- *)
Definition times_edge (d : drive) (e : edge) : edge := (pscale (times d) (fst e), pscale (times d) (snd e)).
Definition clears (g : positive) (d : drive) (p : part) (e : edge) (s : separation) : bool :=
  qle 0 (width s) &&
  match pose g d (qsub (since s) (sets_out d)), pose g d (qsub (until s) (sets_out d)) with
  | Some (z0, c0), Some (z1, c1) =>
      let n := direction s in let far := qmax (pdot n (fst e)) (pdot n (snd e)) in
      let span := qsub (until s) (since s) in let span2 := qmul span span in let whole := Qmake (Zpos g) 1 in
      let its_reach := qmul (times d) (reach p) in let w := qmul (times d) (width s) in
      forallb (fun q =>
        let a := arm d q in let square := speed2 d q in let v := root_above square in let b := qmul (bend d v) span2 in let r := qmul whole (qadd (lift (Qden b) its_reach) b) in let w := qmul whole (lift (Qden b) w) in
        is_above v square && wide n r w (Some (gap_of g n far z0 c0 a)) && wide n r w (Some (gap_of g n far z1 c1 a))) (corners p)
  | _, _ => false
  end.

Lemma clears_ok g d p e s : apt g (terms g) -> clears g d p (times_edge d e) s = true -> 0 <= Q2R (reach p) -> clear_between d p e s.
Proof.
  unfold clears. intros ap h r0. exists (real (direction s)). intros t ht q x hq hx. apply andb_true_iff in h. destruct h as [w0 h]. apply qle_R in w0. rewrite Q2R_0 in w0.
  destruct (pose g d (qsub (since s) (sets_out d))) as [[z0 c0]|] eqn:e0; [|discriminate].
  destruct (pose g d (qsub (until s) (sets_out d))) as [[z1 c1]|] eqn:e1; [|discriminate].
  cbv zeta in h. rewrite forallb_forall in h. specialize (h q hq). unfold times_edge in h; cbn [fst snd] in h.
  set (n := direction s) in *. set (far := qmax _ _) in h. set (span := qsub (until s) (since s)) in *. set (whole := Qmake (Zpos g) 1) in *.
  set (v := root_above (speed2 d q)) in *. set (b := qmul (bend d v) (qmul span span)) in *. set (r := qmul whole (qadd _ b)) in *. set (w := qmul whole (lift _ _)) in *.
  apply andb_true_iff in h. destruct h as [h h1]. apply andb_true_iff in h. destruct h as [known h0].
  apply (speed_ok d q (speed2 d q)) in known; [|apply Rle_refl]. assert (v0 := proj1 known).
  apply (pose_ok _ _ _ _ _ ap) in e0, e1. destruct e0 as [s0 [k0 [n0 p0]]], e1 as [s1 [k1 [n1 p1]]]. specialize (p0 q). specialize (p1 q). rewrite Q2R_sub in p0, p1.
  destruct (times_ok d) as [t0 _].
  assert (G0 : 0 < IZR (Zpos g)) by (apply IZR_lt; reflexivity).
  pose proof (bend_positive d v v0) as b0.
  assert (sp : Q2R span = Q2R (until s) - Q2R (since s)) by (unfold span; apply Q2R_sub).
  assert (er : Q2R r = IZR (Zpos g) * (Q2R (times d) * Q2R (reach p) + Q2R (bend d v) * (Q2R span * Q2R span))).
  { unfold r, whole, b. now rewrite Q2R_mul, Q2R_whole, Q2R_add, Q2R_lift, !Q2R_mul. }
  assert (r0' : 0 <= Q2R (times d) * Q2R (reach p) + Q2R (bend d v) * (Q2R span * Q2R span)).
  { apply Rplus_le_le_0_compat; [apply Rmult_le_pos; lra|apply Rmult_le_pos; [assumption|nra]]. }
  assert (rr : 0 <= Q2R r) by (rewrite er; apply Rmult_le_pos; lra).
  assert (ww : 0 <= Q2R w) by (unfold w, whole; rewrite Q2R_mul, Q2R_whole, Q2R_lift, Q2R_mul; apply Rmult_le_pos; [lra|apply Rmult_le_pos; lra]).
  destruct (wide_ok _ _ _ _ rr ww h0) as [g0 [f0 [l0 m0]]]. destruct (wide_ok _ _ _ _ rr ww h1) as [g1 [f1 [l1 m1]]].
  injection f0 as f0. injection f1 as f1. pose proof (gap_of_ok g n far z0 c0 (arm d q) s0 k0 n0) as a0. pose proof (gap_of_ok g n far z1 c1 (arm d q) s1 k1 n1) as a1.
  rewrite f0, <- p0 in a0. rewrite f1, <- p1 in a1. rewrite dot_scale in a0, a1.
  apply root_times in m0; [|assumption|assumption]. apply root_times in m1; [|assumption|assumption]. rewrite er in m0, m1.
  apply (enough d q v (real n) _ _ t (Q2R far) (Q2R (reach p)) known ht); [|now apply edge_far].
  replace (Q2R (until s) - Q2R (sets_out d) - (Q2R (since s) - Q2R (sets_out d))) with (Q2R span) by (rewrite sp; ring).
  intros c [ec|ec]; subst c; apply Rmult_lt_reg_l with (IZR (Zpos g)); try assumption.
  - apply Rlt_le_trans with (2 := a0). lra.
  - apply Rlt_le_trans with (2 := a1). lra.
Qed.

(* --- The same faster, in whole numbers, most with a coarse sine. Real certificates have so much room that this mostly
   decides. All numbers of a file have one denominator, d: what is multiplied by `times` has d d. --- *)
Definition zabs (a : Z) : Z := if Z.leb 0 a then a else (- a)%Z.
Definition pair_in (d : positive) (p : point) : option (Z * Z) := if in_units d p then Some (Qnum (fst p), Qnum (snd p)) else None.
Definition number_in (d : positive) (a : Q) : option Z := if Pos.eqb (Qden a) d then Some (Qnum a) else None.
Fixpoint pairs_in (d : positive) (l : list point) : option (list (Z * Z)) :=
  match l with
  | [] => Some []
  | p :: r => match pair_in d p, pairs_in d r with Some a, Some m => Some (a :: m) | _, _ => None end
  end.
(* Corners; the reach and the bend of the fastest one, over (g d d) and over g; the largest sum of coordinates. *)
Record quick := { arms : list (Z * Z); quick_reach : Z; quick_bend : Z; size_of_arms : Z }.
Definition quickly (g dd : positive) (d : drive) (p : part) : option quick :=
  let square := fold_right (fun a m => qmax a m) 0%Q (map (speed2 d) (corners p)) in let v := root_above square in
  match pairs_in dd (map (arm d) (corners p)), number_in dd (qmul (times d) (reach p)) with
  | Some l, Some r => if is_above v square then Some {| arms := l; quick_reach := Zpos g * r; quick_bend := up g (bend d v);
      size_of_arms := fold_right (fun a m => zmax (zabs (fst a) + zabs (snd a)) m) 0%Z l |} else None
  | _, _ => None
  end.
Definition place_at := option (point * near_circle).
Definition beyond (g dd : positive) (nx ny far needed size : Z) (l : list (Z * Z)) (p : place_at) : bool :=
  match p with
  | None => false
  | Some (z, (s, k, e)) => in_units dd z &&
      (let x := k * nx + s * ny in let y := k * ny - s * nx in
       let most := needed - (Zpos g * (nx * Qnum (fst z) + ny * Qnum (snd z) - far) - e * size) in
       forallb (fun a => negb (Z.leb (x * fst a + y * snd a) most)) l)%Z
  end.
Definition clears_quickly (g one dd : positive) (turn : Z) (q : quick) (ends : (Z * Z) * (Z * Z)) (s : separation) (here there : place_at) : bool :=
  match pair_in (Qden (fst (direction s))) (direction s), number_in one (since s), number_in one (until s), number_in one (width s) with
  | Some (nx, ny), Some t0, Some t1, Some w =>
      let far := zmax (nx * fst (fst ends) + ny * snd (fst ends)) (nx * fst (snd ends) + ny * snd (snd ends)) in
      let nn := nx * nx + ny * ny in let length := Z.sqrt nn + 1 in let span := t1 - t0 in
      let needed := (quick_reach q + Zpos g * (turn * w) + quick_bend q * (span * span)) * length in
      let size := (zabs nx + zabs ny) * size_of_arms q in
      Z.leb 0 w && Z.leb 0 length && Z.leb nn (length * length) && beyond g dd nx ny far needed size (arms q) here && beyond g dd nx ny far needed size (arms q) there
  | _, _, _, _ => false
  end%Z.

Lemma pair_in_ok d p a : pair_in d p = Some a -> real p = (IZR (fst a) / IZR (Zpos d), IZR (snd a) / IZR (Zpos d)).
Proof.
  unfold pair_in, in_units. destruct (Pos.eqb_spec (Qden (fst p)) d) as [e|_]; [|discriminate]. destruct (Pos.eqb_spec (Qden (snd p)) d) as [f|_]; [|discriminate].
  intro h. injection h as h. subst a. unfold real, Q2R. rewrite e, f. reflexivity.
Qed.
Lemma number_in_ok d a n : number_in d a = Some n -> Q2R a = IZR n / IZR (Zpos d).
Proof. unfold number_in. destruct (Pos.eqb_spec (Qden a) d) as [e|_]; [|discriminate]. intro h. injection h as h. subst n. unfold Q2R. now rewrite e. Qed.
Lemma pairs_in_ok d l : forall m, pairs_in d l = Some m -> forall p, In p l -> exists a, In a m /\ real p = (IZR (fst a) / IZR (Zpos d), IZR (snd a) / IZR (Zpos d)).
Proof.
  induction l as [|q l ih]; intros m h p hp; [destruct hp|]. simpl in h. destruct (pair_in d q) as [a|] eqn:e; [|discriminate].
  destruct (pairs_in d l) as [m'|]; [|discriminate]. injection h as h. subst m. destruct hp as [hp|hp].
  - subst. exists a. split; [now left|now apply pair_in_ok].
  - destruct (ih m' eq_refl p hp) as [b [hb k]]. exists b. split; [now right|assumption].
Qed.
Lemma largest {A} (f : A -> Z) l x : In x l -> IZR (f x) <= IZR (fold_right (fun x m => zmax (f x) m) 0%Z l).
Proof.
  induction l as [|y l ih]; intro h; [destruct h|]. simpl. destruct (zmax_le (f y) (fold_right (fun x m => zmax (f x) m) 0%Z l)) as [a b].
  destruct h as [h|h]; [now subst|]. apply Rle_trans with (2 := b). now apply ih.
Qed.
Lemma largest_square l a : In a l -> Q2R a <= Q2R (fold_right (fun a m => qmax a m) 0%Q l).
Proof.
  induction l as [|b l ih]; intro h; [destruct h|]. cbn [fold_right]. rewrite Q2R_max.
  destruct h as [h|h]; [subst; apply Rmax_l|]. apply Rle_trans with (2 := Rmax_r _ _). now apply ih.
Qed.
Lemma zabs_ok a : IZR (zabs a) = Rabs (IZR a).
Proof.
  unfold zabs. destruct (Z.leb_spec 0 a) as [h|h].
  - apply IZR_le in h. rewrite Rabs_right; lra.
  - apply IZR_lt in h. rewrite opp_IZR, Rabs_left; lra.
Qed.
(* It is at this place then, in the time since the start. *)
Definition placed (g : positive) (d : drive) (t : R) (p : place_at) := forall z c, p = Some (z, c) -> exists si co, encloses g c si co /\ forall q,
  scale (Q2R (times d)) (driven d t (real q)) = add (real z) (add (scale co (real (arm d q))) (scale si (left_of (real (arm d q))))).

Lemma beyond_ok g dd d nx ny far needed size l t p q a : beyond g dd nx ny far needed size l p = true -> placed g d t p ->
  In a l -> real (arm d q) = (IZR (fst a) / IZR (Zpos dd), IZR (snd a) / IZR (Zpos dd)) ->
  (Rabs (IZR nx) + Rabs (IZR ny)) * (Rabs (IZR (fst a)) + Rabs (IZR (snd a))) <= IZR size ->
  IZR needed < IZR (Zpos g) * (IZR (Zpos dd) * (Q2R (times d) * dot (IZR nx, IZR ny) (driven d t (real q))) - IZR far).
Proof.
  intros h hp ha ea hs. unfold beyond in h. destruct p as [[z [[s k] e]]|]; [|discriminate]. apply andb_true_iff in h. destruct h as [hz h].
  rewrite forallb_forall in h. specialize (h a ha). rewrite negb_true_iff in h. apply Z.leb_gt in h. apply IZR_lt in h.
  destruct (hp z (s, k, e) eq_refl) as [si [co [[hsi hco] there]]]. specialize (there q). apply (f_equal (dot (IZR nx, IZR ny))) in there.
  rewrite dot_scale in there. rewrite there. clear there hp. rewrite !dot_add, !dot_scale, ea.
  assert (ez : real z = (IZR (Qnum (fst z)) / IZR (Zpos dd), IZR (Qnum (snd z)) / IZR (Zpos dd))) by (apply (pair_in_ok dd z (Qnum (fst z), Qnum (snd z))); unfold pair_in; now rewrite hz).
  rewrite ez. clear ez ea hz. rewrite !minus_IZR, !plus_IZR, !mult_IZR, !minus_IZR, !plus_IZR, !mult_IZR in h.
  set (G := IZR (Zpos g)) in *. set (E := IZR (Zpos dd)) in *. assert (E0 : 0 < E) by (apply IZR_lt; reflexivity).
  set (x := IZR nx) in *. set (y := IZR ny) in *. set (u := IZR (fst a)) in *. set (v := IZR (snd a)) in *.
  pose proof (near_times _ _ _ (x * u + y * v) hco) as n1. pose proof (near_times _ _ _ (y * u - x * v) hsi) as n2.
  assert (sum : Rabs (x * u + y * v) + Rabs (y * u - x * v) <= (Rabs x + Rabs y) * (Rabs u + Rabs v)).
  { pose proof (Rabs_triang (x * u) (y * v)) as k1. pose proof (Rabs_triang (y * u) (- (x * v))) as k2. rewrite Rabs_Ropp in k2. rewrite !Rabs_mult in k1, k2.
    unfold Rminus. lra. }
  assert (e0 : 0 <= IZR e) by (apply Rle_trans with (2 := hsi), Rabs_pos).
  assert (off : IZR e * (Rabs (x * u + y * v) + Rabs (y * u - x * v)) <= IZR e * IZR size) by (apply Rmult_le_compat_l; lra).
  unfold dot, left_of; cbn [fst snd].
  replace (E * (x * (IZR (Qnum (fst z)) / E) + y * (IZR (Qnum (snd z)) / E) + (co * (x * (u / E) + y * (v / E)) + si * (x * (- (v / E)) + y * (u / E)))))
    with (x * IZR (Qnum (fst z)) + y * IZR (Qnum (snd z)) + (co * (x * u + y * v) + si * (y * u - x * v))) by (field; lra).
  set (A := x * u + y * v) in *. set (B := y * u - x * v) in *.
  assert (same : (IZR k * x + IZR s * y) * u + (IZR k * y - IZR s * x) * v = IZR k * A + IZR s * B) by (unfold A, B; ring).
  rewrite same in h. replace (co * G * A) with (G * (co * A)) in n1 by ring. replace (si * G * B) with (G * (si * B)) in n2 by ring. lra.
Qed.

Lemma clears_quickly_ok g one d p q e ends s here there : quickly g (one * one) d p = Some q -> number_in one (times d) <> None ->
  pair_in (one * one) (pscale (times d) (fst e)) = Some (fst ends) -> pair_in (one * one) (pscale (times d) (snd e)) = Some (snd ends) ->
  clears_quickly g one (one * one) (Qnum (times d)) q ends s here there = true ->
  placed g d (Q2R (since s) - Q2R (sets_out d)) here -> placed g d (Q2R (until s) - Q2R (sets_out d)) there ->
  0 <= Q2R (reach p) -> clear_between d p e s.
Proof.
  intros hq ht he0 he1 h hh tt r0. unfold clears_quickly in h.
  destruct (pair_in (Qden (fst (direction s))) (direction s)) as [[nx ny]|]; [|discriminate].
  set (n := (IZR nx, IZR ny)). exists n. intros t htt c x hc hx. destruct (number_in one (since s)) as [t0|] eqn:e0; [|discriminate].
  destruct (number_in one (until s)) as [t1|] eqn:e1; [|discriminate]. destruct (number_in one (width s)) as [w|] eqn:ew; [|discriminate]. cbv zeta in h.
  destruct (number_in one (times d)) as [tn|] eqn:et; [|congruence]. clear ht.
  assert (etn : Qnum (times d) = tn) by (unfold number_in in et; destruct (Pos.eqb (Qden (times d)) one); [now injection et|discriminate]). rewrite etn in h.
  set (far := zmax _ _) in h. set (len := (Z.sqrt _ + 1)%Z) in h. clearbody len.
    set (needed := ((quick_reach q + Zpos g * (tn * w) + quick_bend q * ((t1 - t0) * (t1 - t0))) * len)%Z) in h. set (size := ((_ + _) * size_of_arms q)%Z) in h.
  apply andb_true_iff in h; destruct h as [h b1]. apply andb_true_iff in h; destruct h as [h b0]. apply andb_true_iff in h; destruct h as [h nl].
  apply andb_true_iff in h; destruct h as [w0 l0]. apply Z.leb_le, IZR_le in w0, l0, nl. rewrite plus_IZR, !mult_IZR in nl.
  unfold quickly in hq. destruct (pairs_in (one * one) (map (arm d) (corners p))) as [l|] eqn:el; [|discriminate].
  destruct (number_in (one * one) (qmul (times d) (reach p))) as [r|] eqn:er; [|discriminate]. set (square := fold_right _ _ (map _ _)) in hq.
  set (v := root_above square) in hq. destruct (is_above v square) eqn:known; [|discriminate].
  apply (speed_ok d c square) in known; [|now apply largest_square, in_map]. assert (v0 := proj1 known). apply (f_equal (fun o => match o with Some q => q | None => q end)) in hq.
    cbv beta iota in hq. subst q.
  cbn [arms quick_reach quick_bend size_of_arms] in *.
  destruct (pairs_in_ok _ _ _ el (arm d c) (in_map _ _ _ hc)) as [a [ha ea]].
  assert (big : IZR (zabs (fst a) + zabs (snd a)) <= IZR (fold_right (fun a m => zmax (zabs (fst a) + zabs (snd a)) m) 0%Z l)) by (apply (largest (fun a => zabs (fst a) + zabs
    (snd a))%Z); assumption).
  pose proof (up_ok g (bend d v)) as bent. set (S := fold_right _ _ l) in *. set (B := up g (bend d v)) in *. clearbody S B.
  rewrite plus_IZR, !zabs_ok in big.
  assert (hsize : (Rabs (IZR nx) + Rabs (IZR ny)) * (Rabs (IZR (fst a)) + Rabs (IZR (snd a))) <= IZR size).
  { unfold size. rewrite mult_IZR, plus_IZR, !zabs_ok. apply Rmult_le_compat_l; [|assumption]. pose proof (Rabs_pos (IZR nx)). pose proof (Rabs_pos (IZR ny)). lra. }
  assert (one0 : 0 < IZR (Zpos one)) by (apply IZR_lt; reflexivity). assert (G0 : 0 < IZR (Zpos g)) by (apply IZR_lt; reflexivity).
  assert (edd : IZR (Zpos (one * one)) = IZR (Zpos one) * IZR (Zpos one)) by (rewrite Pos2Z.inj_mul; apply mult_IZR).
  pose proof (beyond_ok g (one * one) d nx ny far needed size l _ here c a b0 hh ha ea hsize) as k0.
  pose proof (beyond_ok g (one * one) d nx ny far needed size l _ there c a b1 tt ha ea hsize) as k1.
  apply pair_in_ok in he0, he1. fold n in k0, k1.
  apply number_in_ok in e0, e1, ew, et, er. rewrite Q2R_mul in er.
  assert (edge_low : Q2R (times d) * dot n x <= IZR far / IZR (Zpos (one * one))).
  { assert (en : n = real (Qmake nx 1, Qmake ny 1)) by (unfold n, real; cbn [fst snd]; now rewrite !Q2R_whole). rewrite en.
    apply Rle_trans with (1 := edge_far d (Qmake nx 1, Qmake ny 1) e x hx). rewrite Q2R_max, !Q2R_dot, he0, he1, <- en. unfold far.
    destruct (zmax_le (nx * fst (fst ends) + ny * snd (fst ends)) (nx * fst (snd ends) + ny * snd (snd ends))) as [m0 m1].
    set (f := zmax _ _) in *. clearbody f. rewrite plus_IZR, !mult_IZR in m0, m1. set (E := IZR (Zpos (one * one))) in *. assert (E0 : 0 < E) by (apply IZR_lt; reflexivity).
    unfold n, dot; cbn [fst snd]. apply Rmax_lub; apply Rmult_le_reg_r with E; try assumption.
    - replace ((IZR nx * (IZR (fst (fst ends)) / E) + IZR ny * (IZR (snd (fst ends)) / E)) * E)
        with (IZR nx * IZR (fst (fst ends)) + IZR ny * IZR (snd (fst ends))) by (field; lra).
      replace (IZR f / E * E) with (IZR f) by (field; lra). assumption.
    - replace ((IZR nx * (IZR (fst (snd ends)) / E) + IZR ny * (IZR (snd (snd ends)) / E)) * E)
        with (IZR nx * IZR (fst (snd ends)) + IZR ny * IZR (snd (snd ends))) by (field; lra).
      replace (IZR f / E * E) with (IZR f) by (field; lra). assumption. }
  apply (enough d c v n _ _ t _ (Q2R (reach p)) known htt) with (2 := edge_low). clear edge_low.
  destruct (times_ok d) as [T0 _]. set (T := Q2R (times d)) in *. set (D := IZR (Zpos one)) in *. set (E := IZR (Zpos (one * one))) in *. set (G := IZR (Zpos g)) in *.
  set (N := sqrt (dot n n)) in *. assert (N0 : 0 <= N) by apply sqrt_pos.
  assert (NN : N * N = dot n n) by (apply sqrt_sqrt, dot_self).
  assert (NL : N <= IZR len).
  { apply square_le; [assumption|]. apply Rle_trans with (2 := nl). rewrite NN. unfold n, dot; cbn [fst snd]. right. ring. }
  replace (Q2R (until s) - Q2R (sets_out d) - (Q2R (since s) - Q2R (sets_out d))) with (IZR (t1 - t0) / D) by (rewrite e0, e1, minus_IZR; field; lra).
  set (span := IZR (t1 - t0)) in *.
  assert (hneeded : IZR needed = (G * IZR r + G * (IZR tn * IZR w) + IZR B * (span * span)) * IZR len).
  { unfold needed. rewrite mult_IZR, !plus_IZR, !mult_IZR. reflexivity. }
  assert (E0 : 0 < E) by (apply IZR_lt; reflexivity). pose proof (bend_positive d v v0) as bp.
  assert (tn0 : 0 <= IZR tn * IZR w).
  { apply Rmult_le_pos; [|assumption]. rewrite et in T0. apply Rmult_lt_compat_r with (r := D) in T0; [|assumption].
    replace (IZR tn / D * D) with (IZR tn) in T0 by (field; lra). lra. }
  assert (rn : IZR r = T * Q2R (reach p) * E) by (rewrite er; field; lra). rewrite hneeded, rn in k0, k1.
  assert (low : G * E * ((T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))) * N) <=
    (G * (T * Q2R (reach p) * E) + G * (IZR tn * IZR w) + IZR B * (span * span)) * IZR len).
  { assert (left : G * E * (T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))) <= G * (T * Q2R (reach p) * E) + G * (IZR tn * IZR w) + IZR B * (span * span)).
    { assert (s2 : 0 <= span * span) by nra. replace (G * E * (T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))))
        with (G * (T * Q2R (reach p) * E) + G * Q2R (bend d v) * (span * span)) by (rewrite edd; field; lra).
      assert (G * Q2R (bend d v) * (span * span) <= IZR B * (span * span)) by (apply Rmult_le_compat_r; lra).
      assert (0 <= G * (IZR tn * IZR w)) by (apply Rmult_le_pos; lra). lra. }
    assert (pos : 0 <= G * E * (T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D)))).
    { apply Rmult_le_pos; [nra|]. apply Rplus_le_le_0_compat; [apply Rmult_le_pos; lra|]. apply Rmult_le_pos; [assumption|]. apply Rle_0_sqr. }
    replace (G * E * ((T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))) * N)) with
      (G * E * (T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))) * N) by ring.
    apply Rmult_le_compat; assumption. }
  assert (scaled : forall f, (G * (T * Q2R (reach p) * E) + G * (IZR tn * IZR w) + IZR B * (span * span)) * IZR len < G * (E * (T * f) - IZR far) ->
    (T * Q2R (reach p) + Q2R (bend d v) * (span / D * (span / D))) * N < T * f - IZR far / E).
  { intros f hf. assert (GE : 0 < G * E) by now apply Rmult_lt_0_compat. apply Rmult_lt_reg_l with (G * E); [assumption|].
    replace (G * E * (T * f - IZR far / E)) with (G * (E * (T * f) - IZR far)) by (field; lra).
    apply Rle_lt_trans with (2 := hf). apply Rle_trans with (2 := low). right. ring. }
  intros m [em|em]; subst m; apply scaled; assumption.
Qed.

(* --- The places at all moments, of which most are among the latest before --- *)
Record sided := { its : separation; here : place_at; there : place_at }.
Definition same_moment (a b : Q) : bool := Z.eqb (Qnum a) (Qnum b) && Pos.eqb (Qden a) (Qden b).
Fixpoint known_at (known : list (Q * place_at)) (t : Q) : option place_at :=
  match known with [] => None | (u, p) :: r => if same_moment u t then Some p else known_at r t end.
Definition recall (at_ : Q -> place_at) (known : list (Q * place_at)) (t : Q) : place_at * list (Q * place_at) :=
  match known_at known t with Some p => (p, known) | None => let p := at_ t in (p, (t, p) :: firstn 15 known) end.
Fixpoint places (at_ : Q -> place_at) (known : list (Q * place_at)) (l : list separation) : list sided :=
  match l with
  | [] => []
  | s :: r => let (a, k) := recall at_ known (since s) in let (b, k) := recall at_ k (until s) in
      {| its := s; here := a; there := b |} :: places at_ k r
  end.
Definition all_places (g : positive) (d : drive) : list separation -> list sided :=
  let after := pose g d in places (fun t => after (qsub t (sets_out d))) [].

Definition known_place (g : positive) (d : drive) (k : Q * place_at) := placed g d (Q2R (fst k) - Q2R (sets_out d)) (snd k).
Lemma known_at_ok g d known t p : Forall (known_place g d) known -> known_at known t = Some p -> known_place g d (t, p).
Proof.
  intro h. induction h as [|[u q] r hu hr ih]; cbn [known_at]; [discriminate|]. unfold same_moment.
  destruct (Z.eqb_spec (Qnum u) (Qnum t)) as [en|_]; [|exact ih]. destruct (Pos.eqb_spec (Qden u) (Qden t)) as [ed|_]; [|exact ih].
  cbn [andb]. intro e. injection e as e. destruct u as [un ud], t as [tn td]; cbn [Qnum Qden] in *. subst. exact hu.
Qed.
Lemma recall_ok g d at_ known t : (forall t, known_place g d (t, at_ t)) -> Forall (known_place g d) known ->
  known_place g d (t, fst (recall at_ known t)) /\ Forall (known_place g d) (snd (recall at_ known t)).
Proof.
  intros ha h. unfold recall. destruct (known_at known t) as [p|] eqn:e; cbn [fst snd].
  - split; [now apply (known_at_ok g d known)|assumption].
  - split; [apply ha|]. constructor; [apply ha|]. rewrite <- (firstn_skipn 15 known) in h. now apply Forall_app in h.
Qed.
Lemma places_ok g d at_ l : (forall t, known_place g d (t, at_ t)) -> forall known, Forall (known_place g d) known ->
  forall x, In x (places at_ known l) -> known_place g d (since (its x), here x) /\ known_place g d (until (its x), there x).
Proof.
  intro ha. induction l as [|s r ih]; intros known hk x hx; [destruct hx|]. cbn [places] in hx.
  pose proof (recall_ok g d at_ known (since s) ha hk) as [ka h1]. destruct (recall at_ known (since s)) as [a k1].
  pose proof (recall_ok g d at_ k1 (until s) ha h1) as [kb h2]. destruct (recall at_ k1 (until s)) as [b k2].
  destruct hx as [hx|hx]; [subst x; now split|]. now apply (ih k2).
Qed.
Lemma all_places_ok g d l : apt g (terms g) -> forall x, In x (all_places g d l) -> known_place g d (since (its x), here x) /\ known_place g d (until (its x), there x).
Proof.
  intros ap. assert (ha : forall t, known_place g d (t, pose g d (qsub t (sets_out d)))).
  { intros t z c e. apply (pose_ok _ _ _ _ _ ap) in e. now rewrite Q2R_sub in e. }
  now apply places_ok.
Qed.

(* --- A part and an edge, prepared for many separations --- *)
Definition prepare (g : positive) (d : drive) (p : part) : part * option quick := (p, quickly g (Qden (turns d) * Qden (turns d)) d p).
Definition prepare_edge (d : drive) (e : edge) : edge * option ((Z * Z) * (Z * Z)) :=
  let f := times_edge d e in let dd := (Qden (turns d) * Qden (turns d))%positive in
  (f, match pair_in dd (fst f), pair_in dd (snd f) with Some a, Some b => Some (a, b) | _, _ => None end).
Definition fits (g : positive) (d : drive) : part * option quick -> edge * option ((Z * Z) * (Z * Z)) -> sided -> bool :=
  let one := Qden (turns d) in let dd := (one * one)%positive in let turn := times d in
  fun p e s =>
    match number_in one turn, snd p, snd e with
    | Some t, Some q, Some ends => clears_quickly g one dd t q ends (its s) (here s) (there s)
    | _, _, _ => false
    end || clears grain d (fst p) (fst e) (its s).
Lemma fits_ok g d p e s : fits g d (prepare g d p) (prepare_edge d e) s = true ->
  known_place g d (since (its s), here s) -> known_place g d (until (its s), there s) ->
  0 <= Q2R (reach p) -> clear_between d p e (its s).
Proof.
  unfold fits, prepare, prepare_edge. cbv zeta. cbn [fst snd]. intros h hh tt r0. apply orb_true_iff in h. destruct h as [h|h].
  - destruct (number_in (Qden (turns d)) (times d)) as [t|] eqn:et; [|discriminate].
    destruct (quickly g _ d p) as [q|] eqn:eq; [|discriminate].
    destruct (pair_in _ (fst (times_edge d e))) as [a|] eqn:ea; [|discriminate]. destruct (pair_in _ (snd (times_edge d e))) as [b|] eqn:eb; [|discriminate].
    assert (etn : Qnum (times d) = t) by (unfold number_in in et; destruct (Pos.eqb (Qden (times d)) (Qden (turns d))); [now injection et|discriminate]). rewrite <- etn in h.
    apply (clears_quickly_ok g (Qden (turns d)) d p q e (a, b) (its s) (here s) (there s)); try assumption. congruence.
  - apply (clears_ok grain d p e (its s)); try assumption. apply known_apt. now right.
Qed.

(* --- All parts and edges, at all moments --- *)
(* Places are taken times the turn rate: of slower turns the coarse units rarely decide. *)
Definition units_for (d : drive) : positive := if qlt (qabs (turns d)) (1 # 32768) && negb (straight d) then grain else coarse.
Lemma units_apt d : apt (units_for d) (terms (units_for d)).
Proof. apply known_apt. unfold units_for. destruct (_ && _); auto. Qed.
Definition turn_past (d : drive) (o : obstacle) (l : list separation) : bool :=
  let es := edges_of o in let g := units_for d in
  qle (qmul (qabs (turns d)) (qsub (halts d) (sets_out d))) 64
  && forallb (fun p => qle 0 (reach p)) (body_parts d)
  && all_taken its (fits g d) (sets_out d) (halts d) (pairs (map (prepare g d) (body_parts d)) (map (prepare_edge d) es)) (all_places g d l)
  && begins_outside (place_then d) (body_parts d) o es.

Lemma hull_over (f : vec -> R) c ps : (forall x y s, f (mix s x y) = (1 - s) * f x + s * f y) -> (forall p, In p ps -> c < f (real p)) -> forall x, hull ps x -> c < f x.
Proof.
  intros affine h x hx. induction hx as [p hp|x y s _ ix _ iy hs]; [now apply h|]. rewrite affine.
  destruct (Req_dec s 1) as [e|n]; [subst; lra|]. assert (0 < 1 - s) by lra. nra.
Qed.

Theorem turn_past_sound d o l : turn_past d o l = true -> drives_clear d o.
Proof.
  unfold turn_past. set (es := edges_of o). intro h.
  apply andb_true_iff in h; destruct h as [h starts]. apply andb_true_iff in h; destruct h as [h taken]. apply andb_true_iff in h; destruct h as [_ parts].
  rewrite forallb_forall in parts.
  assert (edges : forall t p y x e, 0 <= t <= Q2R (halts d) - Q2R (sets_out d) -> In p (body_parts d) -> hull (corners p) y ->
    dot (sub x (driven d t y)) (sub x (driven d t y)) <= Q2R (reach p) * Q2R (reach p) -> In e es -> ~ on e x).
  { intros t p y x e ht hp hy hx he ox. assert (r0 := parts p hp).
    apply qle_R in r0. rewrite Q2R_0 in r0.
    destruct (all_taken_fits _ _ _ _ _ _ _ taken (prepare (units_for d) d p) (prepare_edge d e) (Q2R (sets_out d) + t)) as [a [ia [hs [s1 [s2 s3]]]]];
      [now apply in_map|now apply in_map|lra|].
    destruct (all_places_ok (units_for d) d l (units_apt d) a ia) as [hh tt]. set (s := its a) in *.
    destruct (fits_ok _ _ _ _ _ hs hh tt r0) as [n k]. fold s in k. specialize (k t ltac:(lra)).
    assert (over : Q2R (reach p) * sqrt (dot n n) < dot n (driven d t y) - dot n x).
    { apply (hull_over (fun y => dot n (driven d t y) - dot n x) _ (corners p)); [|intros q hq; now apply k|assumption].
      intros b c u. rewrite driven_affine, dot_mix. ring. }
    rewrite <- dot_sub in over. pose proof (sqrt_pos (dot n n)) as N0. pose proof (sqrt_sqrt (dot n n) (dot_self n)) as NN.
    assert (far := far_strict n (sub (driven d t y) x) (Q2R (reach p)) (dot n (sub (driven d t y) x))).
    assert (Q2R (reach p) * Q2R (reach p) < dot (sub (driven d t y) x) (sub (driven d t y) x)).
    { set (N := sqrt (dot n n)) in *. assert (0 <= Q2R (reach p) * N) by (apply Rmult_le_pos; lra). apply far; [lra| |lra].
      rewrite <- NN. replace (Q2R (reach p) * Q2R (reach p) * (N * N)) with ((Q2R (reach p) * N) * (Q2R (reach p) * N)) by ring. apply Rmult_le_0_lt_compat; lra. }
    replace (dot (sub x (driven d t y)) (sub x (driven d t y))) with (dot (sub (driven d t y) x) (sub (driven d t y) x)) in hx by (unfold dot, sub; simpl; ring). lra. }
  intros t p y x ht hp hy hx. cbv zeta in hx. split; [|intros e he; now apply (edges t p y x e)].
  intros o' [eo|[]]. subst o'. destruct o as [w|rs]; [exact I|].
  destruct (begins_outside_ok _ _ _ starts p hp) as [v [hv bv]]. fold es in bv. rewrite <- driven_at_start in bv.
  assert (r0 : 0 <= Q2R (reach p) * Q2R (reach p)) by nra. assert (cl : closed es) by apply rings_closed.
  apply (whole_part_even es (driven d t) (corners p) (Q2R (reach p) * Q2R (reach p)) v y); try assumption.
  - intros u a b. apply driven_affine.
  - intros z q hz hq e he. now apply (edges t p z q e).
  - rewrite <- bv. symmetry. replace (odd es (driven d 0 v)) with (odd es (driven d (0 * t) v)) by (now rewrite Rmult_0_l).
    replace (odd es (driven d t v)) with (odd es (driven d (1 * t) v)) by (now rewrite Rmult_1_l).
    apply (odd_path es (fun u => driven d (u * t) v) cl (driven_continuous d v t)).
    intros u hu e he. apply (edges (u * t) p v _ e); try assumption; [nra|].
    replace (dot _ _) with 0; [assumption|]. unfold dot, sub; simpl. ring.
Qed.
